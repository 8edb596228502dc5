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
  InputError(InputPlace where, Problem why, std::optional<std::string> meant = {})
      : InputProblem(input_problem(std::move(where), std::move(why), std::move(meant))) {}
  /// The same, as it is.
  explicit InputError(InputProblem only) : InputProblem(std::move(only)) {}
  /// All problems of one file, in the order in which it is read.
  [[nodiscard]] std::vector<InputProblem> problems() const;

  std::vector<InputProblem> others;  ///< behind the first
};

}  // namespace zwidth
