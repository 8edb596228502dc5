#pragma once

#include <fmt/format.h>

#include <utility>

#include "zwidth/error.hpp"
#include "zwidth/words/problem_text.hpp"

namespace zwidth::internal {

// Throws Error (invalid_argument) of a key of [mechanism].
[[noreturn]] inline void refuse_mechanism(const char* key, Problem problem) {
  InputProblem told = input_problem({.key = key}, std::move(problem), std::nullopt);
  const std::string text = fmt::format("{}: {}; {}", key, told.what, told.allowed);
  throw Error(ErrorCode::invalid_argument, text, {std::move(told)});
}

}  // namespace zwidth::internal
