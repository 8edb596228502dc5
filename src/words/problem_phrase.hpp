#pragma once

#include <span>

#include "zwidth/problem_code.hpp"

namespace zwidth::internal {

// The sentence of a problem, in the syntax of phrase.hpp.
struct ProblemPhrase {
  ProblemCode code;
  const char* name;
  const char* what;
  const char* allowed;
};

[[nodiscard]] std::span<const ProblemPhrase> problem_phrases();

}  // namespace zwidth::internal
