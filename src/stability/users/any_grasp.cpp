#include "stability/users/any_grasp.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "stability/users/grasp_search.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/tip_motion.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth::internal {

bool is_grasped_in_many_directions(const Device& device) {
  const std::optional<TipMotion> motion = tip_motion_of(device);
  return motion && device.parameters().mechanism && tip_directions(*motion).cols() > 1;
}

std::optional<Remark> any_grasp_remark(const Device& device, bool is_known) {
  if (!device.parameters().coordinates) return std::nullopt;
  if (!is_known) return note({.code = FindingCode::any_grasp_not_known});
  if (!is_grasped_in_many_directions(device)) return std::nullopt;
  return note({.code = FindingCode::any_grasp_scanned});
}

std::optional<AbsoluteStabilityLimit> any_grasp_absolute_stability(const Device& device, VirtualDamper damper,
                                                                   const CriticalStiffness& nobody) {
  const std::optional<TipMotion> motion = tip_motion_of(device);
  if (!motion || !device.parameters().mechanism) return std::nullopt;
  DeviceParameters loop = device.parameters();
  const bool is_apart = has_damper_loop(loop.loop) && damper.damping > 0.0;
  if (is_apart) return std::nullopt;
  if (!loop.wall.filters.empty() && nobody.stiffness > 0.0) {
    AbsoluteStabilityLimit limit =
        GraspSearch(device_without_user(device)).limit(GraspSearch::FreeGain::stiffness, damper, nobody);
    limit.trust = nobody.trust;
    return limit;
  }
  loop.loop.damper.reset();
  loop.wall.damping = damper.damping;
  loop.wall.velocity_filter_hz = damper.velocity_filter_hz;
  AbsoluteStabilityLimit limit;
  limit.trust = nobody.trust;
  limit.stiffness = nobody.stiffness;
  if (std::isnan(nobody.stiffness) || nobody.stiffness == 0.0) return limit;
  const Eigen::Vector3d normal(loop.mechanism->normal.data());
  const GraspLimit grasp = any_grasp_limit(*motion, loop, normal);
  limit.needs_no_user = nobody.stiffness <= grasp.stiffness;
  limit.stiffness = std::min(nobody.stiffness, grasp.stiffness);
  if (limit.stiffness == 0.0 || std::isinf(limit.stiffness)) return limit;
  if (!limit.needs_no_user) {
    limit.frequency = grasp.frequency;
  } else if (nobody.limit) {
    limit.frequency = nobody.limit->frequency;
  }
  return limit;
}

}  // namespace zwidth::internal
