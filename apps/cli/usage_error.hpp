#pragma once

#include <CLI/App.hpp>
#include <string>

#include "zwidth/input_problem.hpp"

namespace zwidth::cli {

/// One line that says what is wrong with a command line that CLI11 refused, with "did you mean" for a command or an
/// option that does not exist.
[[nodiscard]] std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

/// CLI11's message on an option, which is all that it tells: with the option where its kind is known, else whole.
[[nodiscard]] InputProblem problem_of_cli11(const std::string& message);

/// A problem of the command's options as one line that names the command.
[[nodiscard]] std::string usage_error(const CLI::App& app, const InputProblem& problem);

}  // namespace zwidth::cli
