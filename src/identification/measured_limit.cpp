#include "zwidth/identification/measured_limit.hpp"

#include <cmath>

namespace zwidth {

std::optional<OptionProblem> find_problem(const MeasuredLimit& limit) {
  std::optional<OptionProblem> found;
  const auto require = [&](bool met, const char* member, double value, ProblemCode code) {
    if (!met && !found) found = option_problem(member, {.code = code, .evidence = {{"value", value}}});
  };
  const auto positive = [](double value) { return std::isfinite(value) && value > 0.0; };
  using enum ProblemCode;
  require(positive(limit.stiffness), "stiffness", limit.stiffness, not_finite_and_positive);
  require(std::isfinite(limit.damping) && limit.damping >= 0.0, "damping", limit.damping, negative);
  const double hz = limit.frequency_hz.value_or(1.0);
  require(positive(hz), "frequency_hz", hz, not_finite_and_positive);
  require(positive(limit.stiffness_deviation), "stiffness_deviation", limit.stiffness_deviation,
          not_finite_and_positive);
  require(positive(limit.frequency_deviation), "frequency_deviation", limit.frequency_deviation,
          not_finite_and_positive);
  return found;
}

}  // namespace zwidth
