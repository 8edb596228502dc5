#pragma once

#include <optional>
#include <vector>

#include "zwidth/design/stable_walls.hpp"

namespace zwidth {

/// What happens to the loop where a wall leaves the stable region.
enum class BoundaryKind {
  oscillation,   ///< a pole pair leaves: it oscillates at the point's frequency
  nyquist,       ///< a pole leaves at z = -1: it oscillates at the Nyquist frequency
  drift,         ///< a pole leaves at z = 1: it drifts away (negative static response)
  no_stiffness,  ///< K = 0: no wall beyond
  no_damping,    ///< B = 0: no wall considered beyond
};

/// A point of the boundary.
struct BoundaryPoint {
  double stiffness = 0.0;                ///< K
  double damping = 0.0;                  ///< B
  std::optional<double> frequency;       ///< rad/s in [0, pi/T]; absent on K = 0 and B = 0
  std::optional<Oscillator> limited_by;  ///< the modal term of largest magnitude there; absent on K = 0 and B = 0
};

/// A stretch of boundary of one kind; straight between points unless `oscillation`, or `nyquist` of two rates.
struct BoundaryArc {
  BoundaryKind kind = BoundaryKind::oscillation;  ///< what happens on it
  std::vector<BoundaryPoint> points;              ///< at least two; the last is the next arc's first, to rounding
};

/// A closed boundary, counter-clockwise in (K, B): the stable walls lie on its left.
struct ClosedBoundary {
  std::vector<BoundaryArc> arcs;  ///< end to end, the last one to the first
};

/// A connected part of the stable region. It has no holes (docs/region.md).
struct StableComponent {
  ClosedBoundary outline;  ///< its outer boundary
  double area = 0.0;       ///< in (K, B), of the polygon
  bool from_zero = false;  ///< it reaches K = 0: the wall may be softened to nothing
};

/// The stable region as polygons.
struct StableRegion {
  std::vector<StableComponent> components;   ///< by falling area
  bool bounded = true;                       ///< false only where the wall does not see the device: P = 0
  std::optional<BoundaryPoint> stiffest;     ///< least upper bound of the stable K, where it is reached
  std::optional<BoundaryPoint> most_damped;  ///< the same of B
  double critical_stiffness = 0.0;           ///< K_CR at B = 0; 0: none stable
  /// The Z-width as one number: the area of all components in the (K, B) plane, N/m times N s/m.
  double area = 0.0;
  /// The greatest distance between two routes to one vertex, as a share of the extent: rounding. Above
  /// usual_vertex_error only where the region ends beside a mode that hardly anything damps.
  double vertex_error = 0.0;
};

inline constexpr double usual_vertex_error = 1e-4;  ///< relative to the extent of the outline

/// How finely an outline is drawn; its corners are exact whatever is asked.
struct OutlineOptions {
  /// Greatest distance of the curve from the polygon, as a share of the region's extent in K and in B. Every vertex
  /// lies on the boundary to rounding whatever it is.
  double deviation = 2e-4;
};

/// The outline of the stable walls.
/// Throws Error (invalid_argument) for a deviation outside (0, 1).
[[nodiscard]] StableRegion stable_region(const StableWalls& walls, OutlineOptions options = {});

}  // namespace zwidth
