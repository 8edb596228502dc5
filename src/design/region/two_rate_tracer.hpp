#pragma once

#include <vector>

#include "design/region/two_rate_slices.hpp"
#include "zwidth/design/stable_region.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// rad from z = -1: nearer, the curve is known by its end there.
inline constexpr double beside_nyquist = 1e-5;

// A stretch of boundary from node to node: the curve turns little between two of them.
struct TwoRateChain {
  BoundaryKind kind = BoundaryKind::oscillation;
  std::vector<BoundaryBranch::Node> nodes;
  bool is_closed = false;  // the last node is the first
};

// Every chain within the slices' gains that a slice meets: followed from there by its tangent and Newton's method, in both
// directions, to where it leaves them. Throws Error (did_not_converge) where it cannot be followed, and at a fineness of 1, that
// of the longest steps, also where two chains have one end alone in common.
[[nodiscard]] std::vector<TwoRateChain> trace_chains(const TwoRateCurve& curve, const RegionSlices& slices,
                                                     int fineness, const Progress& progress);

}  // namespace zwidth::internal
