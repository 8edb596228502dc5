#pragma once

#include <vector>

#include "stability/loop/damper_response.hpp"
#include "stability/users/user_discs.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth::internal {

// AbsoluteStabilitySearch of a device along a normal of a mechanism, whose users grasp its tip in every direction. The least over
// frequency is that of a scan, refined where it is low, from w = 1e-3/T or 3e-4/T to pi/T, and beside the wall's filters; it is not
// shown to be the least in between.
class GraspSearch {
 public:
  explicit GraspSearch(const Device& device);

  // Which gain is free: the stiffness beside the damper; or the damper's, whose VirtualDamper::damping is then 1 N s/m.
  enum class FreeGain { stiffness, damping };

  // `free`: the limit with nobody holding.
  [[nodiscard]] AbsoluteStabilityLimit limit(FreeGain gain, VirtualDamper damper, const CriticalStiffness& free) const;

 private:
  [[nodiscard]] WallResponse wall_at(FreeGain gain, VirtualDamper damper, double frequency) const;

  UserDiscs users_;
  double period_ = 0.0;
  std::vector<double> frequencies_;
  std::vector<TerminationDiscs::Disc> discs_;
};

}  // namespace zwidth::internal
