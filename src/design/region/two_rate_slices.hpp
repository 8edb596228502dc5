#pragma once

#include <vector>

#include "design/region/two_rate_curve.hpp"
#include "zwidth/progress.hpp"

namespace zwidth::internal {

// All there is at one gain inside: every crossing of the gain outside.
struct RegionSlice {
  double inside = 0.0;
  GainCrossings found;  // by rising gain

  [[nodiscard]] bool is_stable(double outside) const { return unstable_poles(found, outside) == 0; }
};
[[nodiscard]] RegionSlice region_slice(const TwoRateCurve& curve, double inside);

struct RegionSlices {
  std::vector<RegionSlice> slices;  // by rising gain inside
  // The gains up to which walls are looked for: beyond them no slice has a stable one. 0 where none has.
  double most_inside = 0.0;
  double most_outside = 0.0;
};

// Slices over all gains inside, by ratios from far below the gains at which something happens to far beyond, and evenly where
// walls are stable; `density` times as many.
[[nodiscard]] RegionSlices region_slices(const TwoRateCurve& curve, int density, const Progress& progress);

// Whether a wall is stable whose gain inside, or outside, is 0.
[[nodiscard]] bool is_stable_on_an_axis(const TwoRateCurve& curve);

}  // namespace zwidth::internal
