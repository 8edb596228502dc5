#include "zwidth/design/region_approximation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "require_argument.hpp"

namespace zwidth {
namespace {

using Formula = RegionApproximation::Formula;

// What the formula allows and what is exact at one B.
struct Row {
  double claimed = 0.0;
  double exact = 0.0;
  double both = 0.0;
};

// Sum over the middles of equal strips of 0 <= B <= largest.
template <typename RowAt>
Row sum_of_strips(double largest, const RowAt& row_at) {
  Row sum;
  for (int i = 0; i < comparison_rows; ++i) {
    const Row row = row_at(largest * (i + 0.5) / comparison_rows);
    sum.claimed += row.claimed;
    sum.exact += row.exact;
    sum.both += row.both;
  }
  return sum;
}

// Each share over the range of B of what it is a share of.
template <typename RowAt>
ApproximationError error_of(const RegionApproximation& approximation, double exact_at_zero, double largest_exact,
                            const RowAt& row_at) {
  ApproximationError error;
  error.at_zero_damping = exact_at_zero;
  constexpr double rounding = 1e-6;
  if (exact_at_zero > 0.0) error.ratio = approximation.at_zero_damping / exact_at_zero;
  error.unsafe = approximation.at_zero_damping > exact_at_zero * (1.0 + rounding);
  if (approximation.largest_damping == 0.0) return error;
  const Row over_claimed = sum_of_strips(approximation.largest_damping.value_or(largest_exact), row_at);
  error.unsafe_share = over_claimed.claimed > 0.0 ? 1.0 - over_claimed.both / over_claimed.claimed : 0.0;
  const Row over_exact = sum_of_strips(largest_exact, row_at);
  error.missed_share = over_exact.exact > 0.0 ? 1.0 - over_exact.both / over_exact.exact : 0.0;
  return error;
}

// The limit at this B, from the polygon.
double limit_at(const AbsoluteStabilityRegion& region, double damping) {
  for (const auto& range : region.ranges) {
    if (damping < range.front().damping || damping > range.back().damping) continue;
    const auto above =
        std::lower_bound(range.begin(), range.end(), damping,
                         [](const AbsoluteStabilityPoint& point, double b) { return point.damping < b; });
    if (above == range.begin()) return above->stiffness;
    const AbsoluteStabilityPoint& below = *(above - 1);
    const double part = (damping - below.damping) / (above->damping - below.damping);
    return below.stiffness + part * (above->stiffness - below.stiffness);
  }
  return 0.0;
}

std::vector<UnmetAssumption> unmet_assumptions(Formula formula, const Device& device) {
  const DeviceParameters& parameters = device.parameters();
  std::vector<UnmetAssumption> unmet;
  if (!parameters.links.empty()) unmet.push_back(UnmetAssumption::flexible_links);
  const bool tied = std::any_of(parameters.bodies.begin(), parameters.bodies.end(),
                                [](const Body& body) { return body.stiffness > 0.0; });
  if (tied) unmet.push_back(UnmetAssumption::springs_to_ground);
  if (parameters.actuator.time_constant > 0.0) unmet.push_back(UnmetAssumption::actuator_lag);
  if (parameters.sensor.tracking_bandwidth > 0.0) unmet.push_back(UnmetAssumption::tracking);
  if (formula == Formula::colgate_schenkel && parameters.loop.delay > 0.0) unmet.push_back(UnmetAssumption::delay);
  if (formula == Formula::gil_hulin && parameters.wall.velocity_filter_hz > 0.0)
    unmet.push_back(UnmetAssumption::velocity_filter);
  if (!parameters.wall.filters.empty()) unmet.push_back(UnmetAssumption::wall_filters);
  if (formula == Formula::gil_hulin && parameters.user.stiffness > 0.0)
    unmet.push_back(UnmetAssumption::user_stiffness);
  return unmet;
}

}  // namespace

std::vector<RegionApproximation> region_approximations(const Device& device, double velocity_filter_hz) {
  internal::require_not_negative({"velocity filter", velocity_filter_hz, "Hz"});
  if (!device.has_bodies()) return {};
  double damping = 0.0;
  for (const Body& body : device.bodies()) damping += body.damping;
  const double with_user = damping + device.parameters().user.damping;
  const double period = device.loop().sampling_period;
  const double half_turn = 0.5 * period + device.loop().delay;
  // (1 - a)/(1 + a)
  const double filter = velocity_filter_hz > 0.0 ? std::tanh(std::numbers::pi * velocity_filter_hz * period) : 1.0;
  std::vector<RegionApproximation> formulas = {
      {Formula::colgate_schenkel, true, 2.0 * damping / period, -2.0 * filter / period, damping / filter},
      {Formula::gil_hulin, false, with_user / half_turn, 1.0 / half_turn, std::nullopt},
      {Formula::diolaiti, true, damping / half_turn, 0.0, 0.0}};
  for (RegionApproximation& each : formulas) each.not_met = unmet_assumptions(each.formula, device);
  return formulas;
}

double stiffness_at(const RegionApproximation& approximation, double damping) {
  if (approximation.largest_damping && damping > *approximation.largest_damping) return 0.0;
  return std::max(approximation.at_zero_damping + approximation.slope * damping, 0.0);
}

ApproximationError approximation_error(const RegionApproximation& approximation, const StableWalls& walls,
                                       double largest_damping) {
  const auto row_at = [&](double damping) {
    Row row{stiffness_at(approximation, damping), 0.0, 0.0};
    for (const StableInterval& interval : walls.stable_stiffnesses(damping)) {
      const double upper = interval.upper.value_or(std::max(row.claimed, interval.lower));
      row.exact += upper - interval.lower;
      row.both += std::max(std::min(upper, row.claimed) - interval.lower, 0.0);
    }
    return row;
  };
  const std::vector<StableInterval> undamped = walls.stable_stiffnesses(0.0);
  const bool from_zero = !undamped.empty() && undamped.front().lower == 0.0 && undamped.front().upper;
  return error_of(approximation, from_zero ? *undamped.front().upper : 0.0, largest_damping, row_at);
}

ApproximationError approximation_error(const RegionApproximation& approximation,
                                       const AbsoluteStabilityRegion& region) {
  const auto row_at = [&](double damping) {
    const double claimed = stiffness_at(approximation, damping);
    const double exact = limit_at(region, damping);
    return Row{claimed, exact, std::min(claimed, exact)};
  };
  return error_of(approximation, limit_at(region, 0.0), region.most_damped ? region.most_damped->damping : 0.0, row_at);
}

}  // namespace zwidth
