#pragma once

#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth::internal {

// A device of a mechanism whose tip moves along several directions. Along one alone, however he grasps it, the user holds it as
// that of bodies.
[[nodiscard]] bool is_grasped_in_many_directions(const Device& device);

// What is said of that limit beside it: that it is of a scan, or that it is not known, and that the pose is singular. Nothing of
// bodies, and of a tip that moves along one direction where it is known.
[[nodiscard]] std::vector<Remark> any_grasp_remarks(const Device& device, bool is_known);

// Whether the tip moves along fewer directions at its pose than beside it.
[[nodiscard]] bool is_pose_singular(const Device& device);

// That it does, with the limits for any passive user at the pose itself and beside it where they are known.
[[nodiscard]] Remark singular_pose_remark(const TipMotion& motion, std::optional<double> at_pose = {},
                                          std::optional<double> beside = {});

// The limit over all passive users of one device along a normal of a mechanism: they grasp its tip in any direction, not along the
// normal alone. The dampers are closed in place of the wall's, behind its filters.
class AnyGrasp {
 public:
  explicit AnyGrasp(const Device& device);

  // Which gain is free: the stiffness beside the damper; or the damper's, whose VirtualDamper::damping is then 1 N s/m.
  enum class FreeGain { stiffness, damping };

  // At most `nobody`, the limit with nobody holding.
  [[nodiscard]] AbsoluteStabilityLimit limit(FreeGain gain, VirtualDamper damper,
                                             const CriticalStiffness& nobody) const;

 private:
  GraspedPlant plant_;
  FilteredPlant filters_;
  double period_ = 0.0;
};

// The same with one damper. Nothing of other devices, and where it is not known: a damper in a loop of its own, a corner too slow.
[[nodiscard]] std::optional<AbsoluteStabilityLimit> any_grasp_absolute_stability(const Device& device,
                                                                                 VirtualDamper damper,
                                                                                 const CriticalStiffness& nobody);

}  // namespace zwidth::internal
