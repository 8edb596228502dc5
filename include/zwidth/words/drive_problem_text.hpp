#pragma once

#include <string>
#include <string_view>

#include "zwidth/drive_problem.hpp"

namespace zwidth {

/// The code's name: "line_too_slow".
[[nodiscard]] std::string_view name_of(DriveProblemCode code);

/// One line with the remedy, from the code and its numbers: "is no serial port". Throws Error (invalid_argument) where it
/// names a number or a text that the problem does not hold.
[[nodiscard]] std::string text(const DriveProblem& problem);

}  // namespace zwidth
