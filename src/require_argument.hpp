#pragma once

#include <cmath>
#include <string>

#include "zwidth/error.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth::internal {

/// Throws Error (invalid_argument) "name is value; ..." unless the argument of a call is within the bounds of the code.
inline void require_argument(bool is_within, ProblemCode code, const Evidence& argument) {
  if (is_within) return;
  Problem problem{.code = code, .evidence = {{"value", argument.value}}, .subjects = {}};
  problem.subjects.push_back({"name", std::string(argument.name)});
  if (!argument.unit.empty()) problem.subjects.push_back({"unit", std::string(argument.unit)});
  throw Error(ErrorCode::invalid_argument, problem);
}

/// The same unless it is finite and > 0.
inline void require_positive(const Evidence& argument) {
  require_argument(argument.value > 0.0 && std::isfinite(argument.value), ProblemCode::not_finite_and_positive,
                   argument);
}

/// The same unless it is above 0 and below 1.
inline void require_fraction(const Evidence& argument) {
  require_argument(argument.value > 0.0 && argument.value < 1.0, ProblemCode::no_fraction, argument);
}

/// The same unless it is finite and >= 0.
inline void require_not_negative(const Evidence& argument) {
  require_argument(argument.value >= 0.0 && std::isfinite(argument.value), ProblemCode::negative, argument);
}

}  // namespace zwidth::internal
