#pragma once

#include <optional>
#include <string>
#include <utility>

#include "zwidth/error.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth {

/// Throws Error (invalid_argument) "member what; allowed" where find_problem(options) found one, with the problem as data
/// and the member for its place.
inline void require_valid(const std::optional<OptionProblem>& problem) {
  if (!problem) return;
  const std::string member = problem->member + (problem->member.empty() ? "" : " ");
  throw Error(ErrorCode::invalid_argument, member + problem->what + "; " + problem->allowed,
              {input_problem_of(*problem, {.option = problem->member})});
}

/// Throws Error (invalid_argument) "key: what; allowed" of a key of a device, with the key for its place.
[[noreturn]] inline void refuse_key(const DeviceProblem& problem) {
  throw Error(ErrorCode::invalid_argument, problem.key + ": " + problem.what + "; " + problem.allowed,
              {input_problem_of(problem, {.key = problem.key})});
}

/// The same, in the words of the problem.
[[noreturn]] inline void refuse_key(std::string key, Problem problem) {
  refuse_key(device_problem(std::move(key), std::move(problem)));
}

/// refuse_key() where find_problem(parameters) found one.
inline void require_valid(const std::optional<DeviceProblem>& problem) {
  if (problem) refuse_key(*problem);
}

/// Throws Error (invalid_argument) of a member of the options, in the words of its problem, which do not name it.
[[noreturn]] inline void refuse_member(const std::string& member, Problem problem) {
  InputProblem found = input_problem({.option = member}, std::move(problem));
  const std::string message = found.what + "; " + found.allowed;
  throw Error(ErrorCode::invalid_argument, message, {std::move(found)});
}

}  // namespace zwidth
