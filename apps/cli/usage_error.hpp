#pragma once

#include <CLI/App.hpp>
#include <string>

namespace zwidth::cli {

/// One line that says what is wrong with a command line that CLI11 refused, with "did you mean" for a command or an
/// option that does not exist.
[[nodiscard]] std::string usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace zwidth::cli
