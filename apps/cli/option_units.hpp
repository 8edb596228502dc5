#pragma once

#include <CLI/App.hpp>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "zwidth/io/number_with_unit.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::cli {

/// Lets every option of the program's commands whose value is shown as S (s), HZ, W (rad/s), M (m or rad), F or FORCE, K
/// (stiffness) or B (damping) take a text with a unit too: --duration "300 ms", --rate "2 kHz", --target "12 kN/m".
void accept_units(CLI::App& app);

/// The text as a number of what is measured, plain in SI units or with a unit: for values that have several parts.
[[nodiscard]] tl::expected<double, UnitProblem> measured_number(std::string_view text, Measure measure, Motion motion);

/// The same; throws BadInput that names the option.
[[nodiscard]] double measured_number(const std::string& option, std::string_view text, Measure measure, Motion motion);

/// Throws BadInput where an option was given in a unit of the other motion than the device's.
void check_option_units(Motion motion);

}  // namespace zwidth::cli
