#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/io/number_with_unit.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::cli {

struct RequestContext;

/// An option that was given with a unit, and why the motions that have no such unit refuse it.
struct GivenUnit {
  std::string option;
  std::optional<UnitProblem> linear;
  std::optional<UnitProblem> rotary;
};

/// A command line, or a request's. Options come before the device, and so before its motion is known: their units are kept.
struct Program : CLI::App {
  using CLI::App::App;
  std::vector<GivenUnit> given_units;
  RequestContext* request = nullptr;  ///< whose commands these are; null on the command line
};

/// Lets every option of the program's commands whose value is shown as S (s), HZ, W (rad/s), M (m or rad), F or FORCE, K
/// (stiffness) or B (damping) take a text with a unit too: --duration "300 ms", --rate "2 kHz", --target "12 kN/m".
void accept_units(Program& program);

/// The text as a number of what is measured, plain in SI units or with a unit: for values that have several parts.
[[nodiscard]] tl::expected<double, UnitProblem> measured_number(std::string_view text, Measure measure, Motion motion);

/// The same; throws BadInput that names the option.
[[nodiscard]] double measured_number(const std::string& option, std::string_view text, Measure measure, Motion motion);

/// Throws BadInput where an option of the command was given in a unit of the other motion than the device's.
void check_option_units(const CLI::App& command, Motion motion);

}  // namespace zwidth::cli
