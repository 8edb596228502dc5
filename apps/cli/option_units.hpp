#pragma once

#include <CLI/App.hpp>

namespace zwidth::cli {

/// Lets every option of the program's commands whose value is shown as S (s), HZ or W (rad/s) take a text with a unit
/// too: --duration "300 ms", --rate "2 kHz", --from "1 Hz".
void accept_units(CLI::App& app);

}  // namespace zwidth::cli
