#pragma once

#include <optional>
#include <string>
#include <utility>

#include "zwidth/error.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth {

/// Throws Error (invalid_argument) "member what; allowed" where find_problem(options) found one, with the problem as data
/// and the member for its place.
inline void require_valid(const std::optional<OptionProblem>& problem) {
  if (!problem) return;
  const std::string member = problem->member + (problem->member.empty() ? "" : " ");
  InputProblem told{{}, problem->what, problem->allowed, {}};
  told.problem = problem->problem;
  told.place.option = problem->member;
  throw Error(ErrorCode::invalid_argument, member + problem->what + "; " + problem->allowed, {std::move(told)});
}

/// Throws Error (invalid_argument) of a member of the options, in the words of its problem, which do not name it.
[[noreturn]] inline void refuse_member(const std::string& member, Problem problem) {
  OptionProblem words = option_problem(member, std::move(problem));
  const std::string message = words.what + "; " + words.allowed;
  InputProblem told{{}, std::move(words.what), std::move(words.allowed), {}};
  told.problem = std::move(words.problem);
  told.place.option = member;
  throw Error(ErrorCode::invalid_argument, message, {std::move(told)});
}

}  // namespace zwidth
