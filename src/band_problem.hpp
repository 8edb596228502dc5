#pragma once

#include <cmath>
#include <optional>
#include <utility>

#include "zwidth/option_problem.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {

/// What is wrong with the members `lowest` and `highest` of a band, rad/s: each above 0 where it is given, and rising.
inline std::optional<OptionProblem> find_band_problem(std::optional<double> lowest, std::optional<double> highest) {
  for (const auto& [member, value] : {std::pair{"lowest", lowest}, std::pair{"highest", highest}}) {
    if (!value || (std::isfinite(*value) && *value > 0.0)) continue;
    return option_problem(member,
                          {.code = ProblemCode::frequency_out_of_range, .evidence = {{"hertz", hertz(*value)}}});
  }
  if (!lowest || !highest || *lowest < *highest) return std::nullopt;
  return option_problem("highest", {.code = ProblemCode::frequency_out_of_range,
                                    .evidence = {{"hertz", hertz(*highest)}, {"lowest", hertz(*lowest)}}});
}

}  // namespace zwidth::internal
