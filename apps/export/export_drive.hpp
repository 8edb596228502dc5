#pragma once

#include <string>

#include "zwidth/design/drive_gains.hpp"

namespace zwidth::report {

/// The settings of a drive's firmware, a line each with its unit, and above them what they rest on: the wall and where its
/// stiffness comes from, the loop as it closes on the drive with its limits, and every doubt. `source`: "wall.stiffness".
[[nodiscard]] std::string export_drive(const Device& device, const DriveGains& gains, const std::string& source);

}  // namespace zwidth::report
