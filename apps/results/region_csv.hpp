#pragma once

#include <string>

#include "zwidth/design/region.hpp"

namespace zwidth::results {

/// The boundary, a line per point: component by number, kind, K, B, rad/s, mode
/// (0: the rigid body; empty on K = 0 and B = 0).
[[nodiscard]] std::string region_csv(const StableRegion& region);

/// `count` values of K and of B, the middles of equal cells over the region's extent and a tenth beyond, with a line
/// per wall: K, B, 1 where it is stable.
[[nodiscard]] std::string region_raster_csv(const WallRegion& walls, std::size_t count);

}  // namespace zwidth::results
