#pragma once

#include <cmath>
#include <cstddef>

namespace zwidth::internal {

// How often the damper runs while the spring runs once: the whole number or whole part whose period is nearest.
[[nodiscard]] double rate_ratio(double loop_period, double damper_period);

// How often the shorter of two such periods fits into the longer.
[[nodiscard]] inline std::size_t periods_within(double longer, double shorter) {
  return static_cast<std::size_t>(std::round(longer / shorter));
}

}  // namespace zwidth::internal
