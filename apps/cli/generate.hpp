#pragma once

#include <CLI/App.hpp>
#include <exception>

namespace zwidth::cli {

/// Adds --generate, which prints a completion script or a manual page made from the program's own options. To be called
/// when all commands are there.
void add_generate(CLI::App& app);

/// Thrown from parsing when --generate has printed: there is nothing else to do.
struct Generated : std::exception {};

}  // namespace zwidth::cli
