#include "sampling/sampling_instants.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "require_argument.hpp"

namespace zwidth::internal {

SamplingInstants sampling_instants(const Sampling& sampling) {
  const auto [period, delay] = sampling;
  require_positive({"sampling period", period, "s"});
  require_not_negative({"delay", delay, "s"});
  // A fraction within rounding of a whole number of samples is that number.
  const double rounding = 4.0 * std::numeric_limits<double>::epsilon() * delay;
  double whole = std::floor(delay / period);
  double rest = std::fma(-whole, period, delay);
  if (period - rest <= rounding) {
    whole += 1.0;
    rest = 0.0;
  } else if (rest <= rounding) {
    rest = 0.0;
  }
  return {static_cast<std::size_t>(whole), period - rest, rest};
}

}  // namespace zwidth::internal
