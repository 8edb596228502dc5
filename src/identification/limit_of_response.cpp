#include "identification/limit_of_response.hpp"

#include <algorithm>
#include <cmath>

namespace zwidth::internal {

Interval with_limit_of_response(const Interval& fitted, const FrequencyResponse& response, const Device& structure,
                                const std::vector<std::string>& locked) {
  constexpr double same = 1e-6;  // of the sampling period
  const double period = structure.loop().sampling_period;
  const bool is_of_loop =
      locked.empty() && response.sampling_period && std::abs(*response.sampling_period - period) <= same * period;
  const bool is_refused = response.trust && response.trust->refused();
  if (!is_of_loop || is_refused || response.points.size() < 2) return fitted;
  const MeasuredStiffness shown = measured_stiffness(response);
  if (!shown.limit) return fitted;
  const Interval interval = stiffness_interval(shown).value_or(shown.limit->stiffness_interval);
  return {std::min(fitted.lower, interval.lower), std::max(fitted.upper, interval.upper)};
}

}  // namespace zwidth::internal
