#pragma once

#include <string>

#include "report/analysed_device.hpp"

namespace zwidth::report {

/// The answer for a wall in every direction: the limits by who holds the tip, and the wall of the file.
[[nodiscard]] std::string point_wall_text(const AnalysedDevice& analysed);

}  // namespace zwidth::report
