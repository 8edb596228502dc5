#pragma once

#include <optional>
#include <string>

#include "zwidth/model/device_key.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth::internal {

/// A number of the options beyond what any device has, with its unit.
inline std::optional<OptionProblem> option_beyond(const std::string& member, double value, const NumberRange& range,
                                                  const std::string& unit) {
  if (range.contains(value)) return std::nullopt;
  return option_problem(member, {.code = ProblemCode::not_between,
                                 .evidence = {{"value", value}, {"least", range.least}, {"most", range.greatest}},
                                 .subjects = {{"unit", unit}}});
}

}  // namespace zwidth::internal
