#pragma once

#include <optional>
#include <string_view>

#include "rig/serial_frame.hpp"

namespace zwidth::rig {

/// A line to SimpleFOC's Commander: "M" and "MG6" make "MMG6". Its buffer has 20 characters; nothing longer is made here.
[[nodiscard]] SerialFrame simplefoc_line(std::string_view motor, std::string_view command) noexcept;
/// The target, in the unit of the motor's torque control: "M0.5".
[[nodiscard]] SerialFrame simplefoc_target(std::string_view motor, double target) noexcept;
/// What stands behind the echo of the command in a line of its machine-readable mode: "1.25" of "MMG1.25"; nothing where
/// the line does not begin with it.
[[nodiscard]] std::optional<std::string_view> simplefoc_answer(std::string_view line, std::string_view motor,
                                                               std::string_view echo) noexcept;

}  // namespace zwidth::rig
