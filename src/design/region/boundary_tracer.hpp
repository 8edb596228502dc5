#pragma once

#include <vector>

#include "design/region/cell_adjacency.hpp"
#include "zwidth/design/stable_region.hpp"

namespace zwidth::internal {

// A closed boundary and the component it belongs to.
struct TracedBoundary {
  ClosedBoundary boundary;
  std::size_t component = 0;
  double gap = 0.0;  // the greatest distance of two routes to one vertex, as a share of the extent
};

// Every closed boundary of the region, the region on its left, with points of the curve so dense that chords stay
// within `deviation` of it (a share of the region's extent in K and in B).
// Throws Error (did_not_converge) where a boundary does not close.
std::vector<TracedBoundary> trace_boundaries(const RegionStructure& structure, double deviation);

}  // namespace zwidth::internal
