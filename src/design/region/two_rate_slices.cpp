#include "design/region/two_rate_slices.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "infinity.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

// Ratios of slices, up to this share of the largest gain inside that the loop stands by itself.
struct Ratio {
  double up_to;
  double ratio;
};
constexpr double lowest_slice = 1e-6;
constexpr Ratio ratios_of_slices[] = {{0.03, 3.0}, {2.0, 1.35}, {30.0, 1.6}};
constexpr int even_slices = 20;
constexpr double beyond_stable = 1.5;  // of the largest stable gain outside

std::vector<double> stable_ends(const RegionSlice& slice) {
  std::vector<double> ends;
  double lower = 0.0;
  for (const GainCrossing& each : slice.found.crossings) {
    if (slice.is_stable(0.5 * (lower + each.gain))) ends.push_back(each.gain);
    lower = each.gain;
  }
  if (slice.is_stable(2.0 * lower + 1.0)) {  // a wall that nothing bounds, though the device is seen
    throw Error(ErrorCode::did_not_converge, {.code = ProblemCode::region_changes_too_often});
  }
  return ends;
}

// The largest gain inside with which the loop is stable with nothing outside; a usual one where there is none.
double stands_alone(const TwoRateCurve& curve) {
  GainCrossings alone = curve.crossings_alone();
  std::ranges::sort(alone.crossings, {}, &GainCrossing::gain);
  double largest = curve.usual_inside();
  double lower = 0.0;
  for (const GainCrossing& each : alone.crossings) {
    if (unstable_poles(alone, 0.5 * (lower + each.gain)) == 0) largest = std::max(largest, each.gain);
    lower = each.gain;
  }
  return largest;
}

}  // namespace

RegionSlice region_slice(const TwoRateCurve& curve, double inside) {
  RegionSlice slice{inside, curve.crossings(inside)};
  std::ranges::sort(slice.found.crossings, {}, &GainCrossing::gain);
  return slice;
}

RegionSlices region_slices(const TwoRateCurve& curve, int density, const Progress& progress) {
  const double alone = stands_alone(curve);
  RegionSlices result;
  const auto add = [&](double inside) {
    tell(progress, 0.0);
    result.slices.push_back(region_slice(curve, inside));
    const std::vector<double> ends = stable_ends(result.slices.back());
    if (!ends.empty()) result.most_outside = std::max(result.most_outside, beyond_stable * ends.back());
    return !ends.empty();
  };
  double highest_stable = 0.0;
  double inside = lowest_slice * alone;
  for (const Ratio& range : ratios_of_slices) {
    for (; inside < range.up_to * alone; inside *= std::pow(range.ratio, 1.0 / density)) {
      try {
        if (!add(inside)) continue;
        highest_stable = inside;
        result.most_inside = inside * range.ratio;
      } catch (const Error& error) {
        // Poles that grow beyond all digits within a period do not come back.
        if (error.code() != ErrorCode::did_not_converge || inside <= alone) throw;
        inside = infinity;
      }
    }
  }
  if (highest_stable == 0.0) return result;
  const int count = even_slices * density;
  for (int i = 1; i <= count; ++i) {
    const double between = result.most_inside * (i - 0.5) / count;
    if (add(between)) highest_stable = std::max(highest_stable, between);
  }
  std::ranges::sort(result.slices, {}, &RegionSlice::inside);
  const auto above =
      std::ranges::find_if(result.slices, [&](const RegionSlice& s) { return s.inside > highest_stable; });
  // The end is between the last slice with a stable wall and the next one.
  result.most_inside = above != result.slices.end() ? above->inside : highest_stable * ratios_of_slices[2].ratio;
  return result;
}

}  // namespace zwidth::internal
