#pragma once

#include <string>

#include "zwidth/design/wall_ceilings.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::report {

/// The two lines of a CHAI3D device's specification that declare its ceilings, with a comment that says what they rest
/// on. Numbers are rounded down to four digits.
[[nodiscard]] std::string export_chai3d(const Device& device, const WallCeilings& ceilings, double safety_factor);

}  // namespace zwidth::report
