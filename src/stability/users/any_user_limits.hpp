#pragma once

#include <optional>
#include <vector>

#include "stability/users/absolute_stability_search.hpp"
#include "stability/users/any_user_limit.hpp"
#include "stability/users/two_rate_users.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/stability/absolute_stability.hpp"

namespace zwidth::internal {

// The limit over all passive users of one device with many dampers, at one rate or two; behind another velocity filter too.
class AnyUserLimits {
 public:
  // Throws as absolute_stability_limit(), and Error (invalid_argument) as require_one_rate() unless bounds_all_users().
  explicit AnyUserLimits(const Device& device, const Progress& progress = {});

  // At two rates a bound unless knows_all_users().
  [[nodiscard]] AbsoluteStabilityLimit limit(VirtualDamper damper, const Progress& progress = {});

  // The B, rising, at which the limit may fall to 0 or rise from it, beside those where nobody's does: a range between two of
  // them may be narrow. Of two rates; none where both run together.
  [[nodiscard]] std::vector<double> ends_of_damper(double velocity_filter_hz) const;

 private:
  [[nodiscard]] AbsoluteStabilitySearch& one_rate(const Progress& progress);

  Device free_;
  std::optional<TwoRateUsers> two_rates_;
  std::optional<AbsoluteStabilitySearch>
      one_rate_;  // of two rates without a damper too, made when it is first asked for
};

}  // namespace zwidth::internal
