#pragma once

#include <CLI/App.hpp>
#include <string>

namespace zwidth::cli {

/// One line that says what is wrong with a command line that CLI11 refused, with "did you mean" for a command or an
/// option that does not exist.
[[nodiscard]] std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

/// CLI11's message on an option as "OPTION: WHAT; ALLOWED", where it has words of its own for what is wrong.
[[nodiscard]] std::string clear_problem(const std::string& message);

}  // namespace zwidth::cli
