#include "zwidth/identification/measured_limit.hpp"

#include <fmt/format.h>

#include <cmath>

namespace zwidth {

std::optional<OptionProblem> find_problem(const MeasuredLimit& limit) {
  std::optional<OptionProblem> found;
  const auto require = [&](bool met, const char* member, double value, const char* allowed) {
    if (!met && !found) found = OptionProblem{member, fmt::format("is {:.9g}", value), allowed};
  };
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  require(positive(limit.stiffness), "stiffness", limit.stiffness, "must be finite and > 0");
  require(std::isfinite(limit.damping) && limit.damping >= 0.0, "damping", limit.damping, "must be finite and >= 0");
  const double hz = limit.frequency_hz.value_or(1.0);
  require(positive(hz), "frequency_hz", hz, "must be finite and > 0");
  require(positive(limit.stiffness_deviation), "stiffness_deviation", limit.stiffness_deviation,
          "must be finite and > 0");
  require(positive(limit.frequency_deviation), "frequency_deviation", limit.frequency_deviation,
          "must be finite and > 0");
  return found;
}

}  // namespace zwidth
