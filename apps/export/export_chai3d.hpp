#pragma once

#include <string>

#include "zwidth/design/safe_wall.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::report {

/// The two lines of a CHAI3D device's specification that declare its ceilings, with a comment that says what they rest
/// on, and why a doubtful one is. Numbers are rounded down to four digits. Requires a wall
/// chosen with Damping::ceiling.
[[nodiscard]] std::string export_chai3d(const Device& device, const SafeWall& ceilings, double safety_factor);

}  // namespace zwidth::report
