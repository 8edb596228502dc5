#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "zwidth/input_problem.hpp"

namespace zwidth {

/// File of a place in an override, which is in no device file.
inline constexpr const char* override_source = "an override";

/// Why an input was refused: the first problem, and the others of the same device file.
struct InputError : InputProblem {
  /// A file's only problem.
  InputError(InputPlace place, Problem problem, std::optional<std::string> suggestion = {})
      : InputProblem(input_problem(std::move(place), std::move(problem), std::move(suggestion))) {}
  /// The same, as it is.
  explicit InputError(InputProblem problem) : InputProblem(std::move(problem)) {}
  /// All problems of one file, in the order in which it is read.
  [[nodiscard]] std::vector<InputProblem> problems() const;

  std::vector<InputProblem> others;  ///< behind the first
};

}  // namespace zwidth
