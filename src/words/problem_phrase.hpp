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

// Of device files.
[[nodiscard]] std::span<const ProblemPhrase> device_file_problem_phrases();

// Of recordings as text.
[[nodiscard]] std::span<const ProblemPhrase> recording_problem_phrases();

// Of recordings in other files.
[[nodiscard]] std::span<const ProblemPhrase> mat_uff_problem_phrases();

// Of studies in files.
[[nodiscard]] std::span<const ProblemPhrase> study_file_problem_phrases();

// Of responses and of what a device is identified from.
[[nodiscard]] std::span<const ProblemPhrase> identification_problem_phrases();

// Of models and designs.
[[nodiscard]] std::span<const ProblemPhrase> model_problem_phrases();

// All lists: these, and that of options, calls and computations, which stands beside this function.
[[nodiscard]] std::span<const std::span<const ProblemPhrase>> problem_phrases();

}  // namespace zwidth::internal
