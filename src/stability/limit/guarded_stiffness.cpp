#include "stability/limit/guarded_stiffness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "stability/limit/gain_crossings.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth::internal {
namespace {

// The limit must hold as closely as this, relative: the poles are counted so far below and above it.
constexpr double closeness = 1e-6;
// Where there is no crossover to count beside: gains of the loop at mid band.
constexpr double loop_gains[] = {1e-3, 1.0, 1e3};

// Poles outside as crossovers say it, from a stable start.
int expected_above(const CriticalStiffness& critical, double stiffness) {
  int outside = 0;
  for (const Crossover& each : critical.crossovers) {
    if (each.stiffness < stiffness) outside += each.poles_leaving;
  }
  return outside;
}

}  // namespace

std::vector<Claim> claims_of(const CriticalStiffness& critical, double gain) {
  std::vector<Claim> claims;
  if (critical.status == StiffnessStatus::finite) {
    const double above = critical.stiffness * (1.0 + closeness);
    claims.push_back({0.5 * critical.stiffness, true});
    claims.push_back({critical.stiffness * (1.0 - closeness), true});
    claims.push_back({above, expected_above(critical, above) == 0});
    return claims;
  }
  const bool stable = critical.status == StiffnessStatus::unbounded;
  double least = std::numeric_limits<double>::infinity();
  for (const Crossover& each : critical.crossovers) least = std::min(least, each.stiffness);
  for (const double loop_gain : loop_gains) {
    const double stiffness = std::isfinite(least) ? 0.5 * least : loop_gain / gain;
    if (stiffness > 0.0 && std::isfinite(stiffness)) claims.push_back({stiffness, stable});
    if (std::isfinite(least)) break;
  }
  return claims;
}

double gain_at_mid_band(const FilteredPlant& plant) {
  return std::abs(response(plant, 0.5 * std::numbers::pi / plant.period));
}

namespace {

// A crossing whose K rounding of the plant's terms may move by more than this, relative, is found again with more digits.
constexpr double closest = 1e-10;

// Beside the pole of a mode that hardly anything damps, or where a filter all but closes, the response keeps few digits,
// and K = -1/P - B v fewer.
void polish(const PoleCount& poles, GainCrossings& found) {
  std::vector<GainCrossing*> unsure;
  std::vector<PoleOnCircle> again;
  for (GainCrossing& crossing : found.crossings) {
    if (crossing.noise <= closest * crossing.gain) continue;
    unsure.push_back(&crossing);
    again.push_back({crossing.angle, crossing.gain});
  }
  poles.polish_in_digits(again);
  for (std::size_t i = 0; i < unsure.size(); ++i) {
    unsure[i]->angle = again[i].angle;
    unsure[i]->gain = again[i].stiffness;
  }
  std::erase_if(found.crossings, [](const GainCrossing& each) { return !(each.gain > 0.0); });
}

// A pole that only touches the circle at the limit, inside on either side, must lie on it there: poles close together
// make up touches that are none.
void doubt_touch_without_pole(const Device& device, CriticalStiffness& critical) {
  constexpr double on_circle = 1e-6;
  constexpr std::size_t most_samples = 40;  // beyond, eigenvalues would take longer than all the rest
  if (!critical.limit || critical.limit->poles_leaving != 0) return;
  const DiscreteStateSpace plant = sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
  if (plant.delay_samples > most_samples) return;
  Wall wall = device.parameters().wall;
  wall.stiffness = critical.stiffness;
  if (!(stability_excess(plant, wall) < -on_circle)) return;
  critical.trust.doubt({.code = FindingCode::touch_without_pole, .evidence = {{"limit", critical.stiffness}}});
}

// A free device that leaves so slowly that a wall of a millionth of the limit holds it: rounded coefficients.
void doubt_slow_instability(CriticalStiffness& critical) {
  constexpr double negligible = 1e-6;
  if (critical.status != StiffnessStatus::none_stable || critical.stable_intervals.empty()) return;
  const StableInterval& first = critical.stable_intervals.front();
  if (!first.upper || first.lower > negligible * *first.upper) return;
  critical.trust.doubt(
      {.code = FindingCode::slow_instability, .evidence = {{"holding", first.lower}, {"limit", *first.upper}}});
}

}  // namespace

Agreement agreement(const PoleCount& poles, double stiffness, bool stable) {
  if (poles.confirms(stiffness, stable)) return Agreement::agrees;
  const std::optional<int> sure = poles.in_digits(stiffness);
  if (!sure) return Agreement::undecided;
  return (*sure == 0) == stable ? Agreement::agrees : Agreement::contradicts;
}

void distrust(Agreement agreement, double stiffness, Trust& trust) {
  if (agreement == Agreement::contradicts) {
    trust.refuse({.code = FindingCode::second_route_contradicts, .evidence = {{"stiffness", stiffness}}});
  }
  if (agreement == Agreement::undecided) {
    trust.doubt({.code = FindingCode::second_route_undecided, .evidence = {{"stiffness", stiffness}}});
  }
}

void withdraw(CriticalStiffness& critical) {
  Trust trust = std::move(critical.trust);
  critical = {};
  critical.status = StiffnessStatus::refused;
  critical.stiffness = std::numeric_limits<double>::quiet_NaN();
  critical.trust = std::move(trust);
}

CriticalStiffness guarded_stiffness(const Device& device, const FilteredPlant& plant, const PoleCount& poles) {
  const VirtualDamper damper = virtual_damper(device);
  CriticalStiffness critical;
  try {
    GainCrossings crossings = stiffness_crossings(plant, damper);
    polish(poles, crossings);
    critical = critical_stiffness_of(plant, crossings);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    critical.trust.refuse({.code = FindingCode::not_converged, .subjects = {{"reason", error.what()}}});
  }
  critical.trust.inherit(trust_of(device));
  if (critical.trust.refused()) {
    withdraw(critical);
    return critical;
  }
  for (const Claim& claim : claims_of(critical, gain_at_mid_band(plant))) {
    if (critical.trust.refused()) break;
    distrust(agreement(poles, claim.stiffness, claim.stable), claim.stiffness, critical.trust);
  }
  if (critical.trust.refused()) withdraw(critical);
  doubt_slow_instability(critical);
  doubt_touch_without_pole(device, critical);
  return critical;
}

}  // namespace zwidth::internal
