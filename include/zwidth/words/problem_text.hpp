#pragma once

#include <string>
#include <string_view>

#include "zwidth/option_problem.hpp"

namespace zwidth {

/// The code's name: "count_out_of_range".
[[nodiscard]] std::string_view name_of(ProblemCode code);

/// A problem in words.
struct ProblemWords {
  std::string what;     ///< "is -1 s"
  std::string allowed;  ///< "must be finite and > 0"
};

/// The words of a problem, from its code and its numbers. Throws Error (invalid_argument) where its sentence names a
/// number or a text that the problem does not hold.
[[nodiscard]] ProblemWords words_of(const Problem& problem);

}  // namespace zwidth
