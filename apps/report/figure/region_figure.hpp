#pragma once

#include <optional>
#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/design/region.hpp"

namespace zwidth::report {

/// The stable walls, B to the right and K up, with those that no passive user destabilises and the formulas of the
/// literature; where these lie in a corner of the region, that corner beside it. `recommended`: a wall to mark. Throws
/// OutputFailed.
[[nodiscard]] std::string draw_region(const Device& device, const WallRegion& walls, FigureFormat format,
                                      const std::optional<Wall>& recommended = std::nullopt);

}  // namespace zwidth::report
