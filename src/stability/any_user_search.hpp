#pragma once

#include <vector>

#include "stability/user_discs.hpp"
#include "zwidth/stability/any_user.hpp"

namespace zwidth::internal {

/// any_user_limit() of one device for many dampers: the discs do not depend on the damper and are summed once.
class AnyUserSearch {
 public:
  /// Throws as any_user_limit().
  explicit AnyUserSearch(const Device& device);

  [[nodiscard]] AnyUserLimit limit(VirtualDamper damper) const;

 private:
  /// The stiffness that the condition allows at one frequency, rad/s.
  struct Sample {
    double frequency = 0.0;
    double stiffness = 0.0;
  };
  [[nodiscard]] double limit_at(VirtualDamper damper, double frequency) const;
  [[nodiscard]] std::vector<Sample> scan(VirtualDamper damper, const CriticalStiffness& free) const;

  UserDiscs discs_;
  double period_ = 0.0;
  std::vector<double> frequencies_;        // where the condition may be tightest with any damper, rising
  std::vector<UserDiscs::Disc> discs_at_;  // at those
};

}  // namespace zwidth::internal
