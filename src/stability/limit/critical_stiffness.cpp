#include "zwidth/stability/critical_stiffness.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <string>

#include "require_argument.hpp"
#include "stability/limit/gain_crossings.hpp"
#include "stability/limit/guarded_stiffness.hpp"
#include "stability/limit/oscillator_at.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "zwidth/model/damper_timing.hpp"

namespace zwidth {
using namespace internal;

VirtualDamper virtual_damper(const Device& device) {
  require_one_rate(device);
  return {device.parameters().wall.damping, device.parameters().wall.velocity_filter_hz};
}

CriticalStiffness critical_stiffness(const Device& device) {
  if (has_damper_loop(device.loop())) return two_rate_stiffness(device);
  return guarded_stiffness(device, filtered_plant(device), PoleCount(device));
}

CriticalStiffness critical_stiffness(const FilteredPlant& plant, VirtualDamper damper) {
  require_not_negative({"virtual damper", damper.damping});
  require_not_negative({"velocity filter", damper.velocity_filter_hz, "Hz"});
  return critical_stiffness_of(plant, stiffness_crossings(plant, damper));
}

CriticalStiffness internal::critical_stiffness_of(const FilteredPlant& plant, const GainCrossings& crossings) {
  return critical_stiffness_of(plant, crossings, plant);
}

CriticalStiffness internal::critical_stiffness_of(const FilteredPlant& plant, const GainCrossings& crossings,
                                                  const SampledPlant& modes) {
  CriticalStiffness result;
  result.crossovers.reserve(crossings.crossings.size());
  for (const GainCrossing& crossing : crossings.crossings) {
    result.crossovers.push_back(
        {crossing.angle >= std::numbers::pi ? std::numbers::pi / plant.period : crossing.angle / plant.period,
         crossing.gain, oscillator_at(modes, crossing.angle), crossing.poles_leaving});
  }
  find_limit(result, crossings.initially_unstable);
  return result;
}

void internal::find_limit(CriticalStiffness& result, int initially_unstable) {
  // Stable intervals of K: wherever no pole is outside.
  std::vector<const Crossover*> by_stiffness;
  for (const Crossover& crossover : result.crossovers) by_stiffness.push_back(&crossover);
  std::sort(by_stiffness.begin(), by_stiffness.end(),
            [](const Crossover* a, const Crossover* b) { return a->stiffness < b->stiffness; });
  int unstable = initially_unstable;
  double lower = 0.0;
  for (const Crossover* crossover : by_stiffness) {
    if (unstable == 0 && crossover->stiffness > lower) result.stable_intervals.push_back({lower, crossover->stiffness});
    unstable += crossover->poles_leaving;
    lower = crossover->stiffness;
  }
  if (unstable == 0) result.stable_intervals.push_back({lower, std::nullopt});

  if (result.stable_intervals.empty() || result.stable_intervals.front().lower > 0.0) {
    result.status = StiffnessStatus::none_stable;
    result.stiffness = 0.0;
  } else if (!result.stable_intervals.front().upper) {
    result.status = StiffnessStatus::unbounded;
    result.stiffness = std::numeric_limits<double>::infinity();
  } else {
    result.status = StiffnessStatus::finite;
    result.stiffness = *result.stable_intervals.front().upper;
    result.limit = *by_stiffness.front();
  }
}

}  // namespace zwidth
