#include "design/region/two_rate_slices.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "staged_progress.hpp"
#include "zwidth/error.hpp"

namespace zwidth::internal {
namespace {

// Slices by these ratios: below and among the gains inside at which something happens, and beyond them.
constexpr double ratio_below = 3.0;
constexpr double ratio_among = 1.35;
constexpr double ratio_beyond = 1.6;
// In shares of the least of these gains, and of the greatest.
constexpr double lowest_slice = 1e-6;
constexpr double first_among = 0.03;
constexpr double last_among = 2.0;
constexpr double highest_slice = 30.0;
constexpr double slow_angle = 0.1;  // rad a period inside
constexpr int even_slices = 20;
// Between two slices that differ by more than the places of their crossings walls may be stable: so often halved.
constexpr int most_halvings_between = 4;
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

// Whether the same crossings come in the same order.
bool is_alike(const RegionSlice& a, const RegionSlice& b) {
  const auto same = [](const GainCrossing& first, const GainCrossing& second) {
    return first.poles_leaving == second.poles_leaving &&
           (first.angle == std::numbers::pi) == (second.angle == std::numbers::pi);
  };
  return a.found.initially_unstable == b.found.initially_unstable &&
         std::ranges::equal(a.found.crossings, b.found.crossings, same);
}

// The gains inside at which something happens: crossings of the loop with nothing outside, and its usual gain. A device whose
// sensed body is not the actuated one has crossings at a tiny share of the usual gain.
struct Scales {
  double least = 0.0;
  double greatest = 0.0;  // the largest with which the loop is stable with nothing outside, or the usual one
};

Scales scales_of(const TwoRateCurve& curve) {
  GainCrossings alone = curve.crossings_alone();
  std::ranges::sort(alone.crossings, {}, &GainCrossing::gain);
  Scales scales{curve.usual_inside(1.0), curve.usual_inside(1.0)};
  if (alone.crossings.empty()) scales.least = std::min(scales.least, curve.usual_inside(slow_angle));
  double lower = 0.0;
  for (const GainCrossing& each : alone.crossings) {
    scales.least = std::min(scales.least, each.gain);
    if (unstable_poles(alone, 0.5 * (lower + each.gain)) == 0) scales.greatest = std::max(scales.greatest, each.gain);
    lower = each.gain;
  }
  constexpr double near = 1e3;
  if (scales.greatest < near * scales.least) scales.least = scales.greatest;
  return scales;
}

// The factor to the next slice.
double ratio_at(double inside, const Scales& scales, int density) {
  const double ratio = inside < first_among * scales.least     ? ratio_below
                       : inside < last_among * scales.greatest ? ratio_among
                                                               : ratio_beyond;
  return std::pow(ratio, 1.0 / density);
}

}  // namespace

RegionSlice region_slice(const TwoRateCurve& curve, double inside) {
  RegionSlice slice{inside, curve.crossings(inside)};
  std::ranges::sort(slice.found.crossings, {}, &GainCrossing::gain);
  return slice;
}

RegionSlices region_slices(const TwoRateCurve& curve, int density, const Progress& progress) {
  const Scales scales = scales_of(curve);
  RegionSlices result;
  const auto add = [&](double inside) {
    tell(progress, 0.0);
    result.slices.push_back(region_slice(curve, inside));
    const std::vector<double> ends = stable_ends(result.slices.back());
    if (!ends.empty()) result.most_outside = std::max(result.most_outside, beyond_stable * ends.back());
    return !ends.empty();
  };
  double highest_stable = 0.0;
  double inside = lowest_slice * scales.least;
  while (inside < highest_slice * scales.greatest) {
    const double next = inside * ratio_at(inside, scales, density);
    try {
      if (add(inside)) {
        highest_stable = inside;
        result.most_inside = next;
      }
    } catch (const Error& error) {
      // Poles that grow beyond all digits within a period do not come back.
      if (error.code() != ErrorCode::did_not_converge || inside <= scales.greatest) throw;
      break;
    }
    inside = next;
  }
  if (highest_stable == 0.0) return result;
  const auto look_between = [&](const auto& self, std::size_t below, std::size_t above, int halvings) -> void {
    if (halvings == 0 || is_alike(result.slices[below], result.slices[above])) return;
    const double between = std::sqrt(result.slices[below].inside * result.slices[above].inside);
    const std::size_t middle = result.slices.size();
    if (add(between)) {
      highest_stable = std::max(highest_stable, between);
      result.most_inside = std::max(result.most_inside, result.slices[above].inside);
    }
    self(self, below, middle, halvings - 1);
    self(self, middle, above, halvings - 1);
  };
  for (std::size_t i = 1, last = result.slices.size(); i < last; ++i) {
    if (result.slices[i - 1].inside >= highest_stable) look_between(look_between, i - 1, i, most_halvings_between);
  }
  const int count = even_slices * density;
  for (int i = 1; i <= count; ++i) {
    const double between = result.most_inside * (i - 0.5) / count;
    if (add(between)) highest_stable = std::max(highest_stable, between);
  }
  std::ranges::sort(result.slices, {}, &RegionSlice::inside);
  const auto above =
      std::ranges::find_if(result.slices, [&](const RegionSlice& s) { return s.inside > highest_stable; });
  // The end is between the last slice with a stable wall and the next one.
  result.most_inside = above != result.slices.end() ? above->inside : highest_stable * ratio_beyond;
  return result;
}

bool is_stable_on_an_axis(const TwoRateCurve& curve) {
  if (!stable_ends(region_slice(curve, 0.0)).empty()) return true;
  const RegionSlice alone{0.0, curve.crossings_alone()};
  return !stable_ends(alone).empty();
}

}  // namespace zwidth::internal
