#pragma once

#include <cstddef>
#include <optional>

#include "design/region/boundary_curve.hpp"
#include "zwidth/design/stable_region.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// What closed-loop poles, by matrix exponential and eigenvalues, say of a region.
struct RegionCheck {
  std::size_t asked = 0;      // walls
  std::size_t confirmed = 0;  // of them; the others lie on the boundary to rounding
  std::optional<WallPoint> contradiction;
};

// Walls over the extent of the region and somewhat beyond, evenly and by ratios, and beside the boundary on both sides.
// The same walls must be in the outline as in the intervals. Their number falls with the order of the loop, to none
// beyond a cap.
RegionCheck check_region(const Device& device, const StableWalls& walls, const StableRegion& region, double deviation,
                         const Progress& progress = {});

}  // namespace zwidth::internal
