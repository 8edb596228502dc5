#include "zwidth/stability/wall_margins.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "stability/limit/gain_crossings.hpp"
#include "stability/margins/delay_margin.hpp"
#include "stability/margins/two_rate_margins.hpp"
#include "stability/margins/unit_gain.hpp"
#include "stability/second_route/spectral_radius.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;

void check(const Wall& wall) {
  for (const double value : {wall.stiffness.value_or(-1.0), wall.damping, wall.velocity_filter_hz}) {
    if (!(value >= 0.0) || !std::isfinite(value)) {
      throw Error(ErrorCode::invalid_argument,
                  {.code = ProblemCode::wall_not_possible, .evidence = {{"value", value}}});
    }
  }
}

// Gain margins: the crossings of the locus of one factor on the whole wall, on both sides of 1.
void find_gain_margins(const GainCrossings& crossings, double factor_at_wall, LoopMargins& margins) {
  for (const GainCrossing& crossing : crossings.crossings) {
    const double factor = crossing.gain / factor_at_wall;
    if (factor > 1.0) margins.gain_margin = std::min(margins.gain_margin.value_or(factor), factor);
    if (factor < 1.0) margins.lower_gain_margin = std::max(margins.lower_gain_margin.value_or(factor), factor);
  }
}

// Smallest phase and delay that take any gain crossover to -1.
void find_phase_margins(const FilteredPlant& plant, const Wall& wall, LoopMargins& margins) {
  for (const UnitGainPoint& point : unit_gain_points(plant, wall)) {
    const double frequency = point.angle / plant.period;
    margins.gain_crossovers.push_back({frequency, point.phase});
    if (!margins.stable) continue;
    const double delay = lag_to_instability(point) / frequency;
    margins.phase_margin = std::min(margins.phase_margin.value_or(pi), std::abs(point.phase));
    margins.delay_margin = std::min(margins.delay_margin.value_or(delay), delay);
  }
}

// Without a spring and a damper: undamped modes, and the speed of what nothing damps. The position that nothing holds, one
// pole at z = 1, is no instability.
bool keeps_moving(const FilteredPlant& plant, const Wall& wall) {
  return wall.damping == 0.0 && std::any_of(plant.terms.begin(), plant.terms.end(), [](const SampledTerm& term) {
           return term.integrators > 1 || term.undamped_pairs > 0;
         });
}

// Whether every pole counts, or the one at z = 1 of a position that nothing holds is left out.
CountedPoles holds_position(const FilteredPlant& plant, const Wall& wall) {
  const bool is_free =
      std::any_of(plant.terms.begin(), plant.terms.end(), [](const SampledTerm& term) { return term.integrators > 0; });
  return *wall.stiffness == 0.0 && is_free ? CountedPoles::but_free_position : CountedPoles::all;
}

}  // namespace

LoopMargins loop_margins(const FilteredPlant& plant, const Wall& wall) {
  check(wall);
  const double stiffness = *wall.stiffness;
  const VirtualDamper damper{wall.damping, wall.velocity_filter_hz};
  LoopMargins margins;
  if (stiffness == 0.0) {
    const GainCrossings by_damping = damping_crossings(plant, damper);
    margins.stable = !keeps_moving(plant, wall) && unstable_poles(by_damping, wall.damping) == 0;
    if (margins.stable && wall.damping > 0.0) find_gain_margins(by_damping, wall.damping, margins);
  } else {
    const GainCrossings by_stiffness = stiffness_crossings(plant, damper);
    const bool on_crossing = std::any_of(by_stiffness.crossings.begin(), by_stiffness.crossings.end(),
                                         [&](const GainCrossing& crossing) { return crossing.gain == stiffness; });
    margins.stable = !on_crossing && unstable_poles(by_stiffness, stiffness) == 0;
    if (margins.stable) {
      find_gain_margins(by_stiffness, stiffness, margins);
      margins.stiffness_margin = margins.gain_margin;
    }
    if (margins.stable && wall.damping > 0.0) {
      margins.gain_margin.reset();
      margins.lower_gain_margin.reset();
      find_gain_margins(gain_crossings(plant, GainLocus(plant, GainLocus::Gain::wall, stiffness, damper)), 1.0,
                        margins);
    }
  }
  find_phase_margins(plant, wall, margins);
  return margins;
}

WallMargins wall_margins(const Device& device) {
  if (has_damper_loop(device.loop())) return two_rate_margins(device);
  constexpr std::size_t most_samples_for_eigenvalues = 100;
  const Wall& wall = device.parameters().wall;
  const FilteredPlant plant = filtered_plant(device);
  WallMargins margins{loop_margins(plant, wall), *wall.stiffness, wall.damping, 0.0};
  if (plant.delay_samples > most_samples_for_eigenvalues) {
    margins.spectral_radius = spectral_radius_by_winding(plant, wall);
  } else {
    const Sampling sampling{device.loop().sampling_period, device.loop().delay};
    const DiscreteStateSpace sampled = sample(state_space(device), sampling);
    margins.spectral_radius = 1.0 + stability_excess(sampled, wall, holds_position(plant, wall));
  }
  if (margins.stable) margins.delay_margin = exact_delay_margin(device);
  return margins;
}

}  // namespace zwidth
