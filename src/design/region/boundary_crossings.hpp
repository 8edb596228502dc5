#pragma once

#include <span>
#include <vector>

#include "design/region/boundary_segment.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// Every wall with K >= 0, B >= 0 where two of the segments cross, and those that touch to finest_detail. Two segments
// that follow one another do not cross at their common end.
struct BoundaryCrossings {
  std::vector<WallPoint> walls;
  // A pair was left only where models on both whole segments prove that it does not cross, or crosses at most once;
  // false where a cap on the number of pairs was hit, or the models are estimates.
  bool complete = true;
};
BoundaryCrossings boundary_crossings(const BoundaryCurve& curve, std::span<const BoundarySegment> segments,
                                     const Progress& progress = {});

}  // namespace zwidth::internal
