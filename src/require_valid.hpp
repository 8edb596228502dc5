#pragma once

#include <optional>
#include <utility>

#include "zwidth/error.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth::internal {

/// Throws Error (invalid_argument) "member what; allowed" where find_problem(options) found one.
inline void require_valid(const std::optional<OptionProblem>& problem) {
  if (!problem) return;
  const std::string member = problem->member + (problem->member.empty() ? "" : " ");
  InputProblem told{{}, problem->what, problem->allowed, {}};
  told.problem = problem->problem;
  told.place.option = problem->member;
  throw Error(ErrorCode::invalid_argument, member + problem->what + "; " + problem->allowed, {std::move(told)});
}

}  // namespace zwidth::internal
