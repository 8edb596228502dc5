#pragma once

#include <optional>

#include "zwidth/design/stable_region.hpp"
#include "zwidth/design/stable_walls.hpp"
#include "zwidth/stability/holding.hpp"

namespace zwidth {

/// An extreme of the walls that two holders both leave stable.
struct SharedPoint {
  BoundaryPoint point;             ///< of the boundary that ends them there
  Holder holder = Holder::nobody;  ///< whose boundary that is
};

/// The walls (K, B) that are stable with nobody holding and with the file's user: those to build on, for a person lets go.
struct SharedWalls {
  double critical_stiffness = 0.0;         ///< the lesser K_CR at B = 0; 0: none is stable from K = 0 on
  std::optional<SharedPoint> stiffest;     ///< least upper bound of K; absent where there is no such wall, or no bound
  std::optional<SharedPoint> most_damped;  ///< the same of B
  double area = 0.0;                       ///< in (K, B), of the polygons; infinite where neither region is bounded
};

/// The walls of both, of devices with one period and one velocity filter.
///
/// The area is that of the intersection of both outlines, to rounding. The extremes are those of the exact stable intervals:
/// over B they are looked for at every vertex of both outlines and where these cross, and refined there.
[[nodiscard]] SharedWalls shared_walls(const StableWalls& nobody, const StableRegion& nobodys_region,
                                       const StableWalls& user, const StableRegion& users_region);

}  // namespace zwidth
