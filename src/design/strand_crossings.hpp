#pragma once

#include <span>
#include <vector>

#include "design/strand.hpp"

namespace zwidth::internal {

// Every wall with K >= 0, B >= 0 where two of the strands cross, and those that touch to finest_detail. Two strands
// that follow one another do not cross at their common end. Complete: a pair is left only where models on both whole
// strands prove that it does not cross, or crosses at most once. Throws Error (did_not_converge) past a cap on the
// number of pairs.
std::vector<WallPoint> strand_crossings(const BoundaryCurve& curve, std::span<const Strand> strands);

}  // namespace zwidth::internal
