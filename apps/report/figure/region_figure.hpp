#pragma once

#include <string>

#include "report/device_region.hpp"
#include "report/figure/canvas.hpp"

namespace zwidth::report {

/// The stable walls, B to the right and K up, with those that no passive user destabilises and the formulas of the
/// literature; where these lie in a corner of the region, that corner beside it. Throws OutputFailed.
[[nodiscard]] std::string draw_region(const DeviceRegion& device, FigureFormat format);

}  // namespace zwidth::report
