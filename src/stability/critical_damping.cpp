#include "zwidth/stability/critical_damping.hpp"

#include <limits>
#include <utility>

#include "stability/limit/gain_crossings.hpp"
#include "stability/limit/guarded_stiffness.hpp"
#include "stability/users/absolute_stability_search.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_key.hpp"
#include "zwidth/model/device_trust.hpp"

namespace zwidth {
using namespace internal;
namespace {

constexpr double closeness = 1e-6;  // relative, of the dampers beside the limit at which poles are counted

Device with_damping(const Device& device, double damping) {
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty.reset();
  parameters.wall.damping = damping;
  return Device(std::move(parameters));
}

CriticalDamping as_damping(CriticalStiffness gains) {
  const auto crossover = [](const Crossover& each) {
    return DampingCrossover{each.frequency, each.stiffness, each.limited_by, each.poles_leaving};
  };
  CriticalDamping result;
  result.status = gains.status;
  result.damping = gains.stiffness;
  if (gains.limit) result.limit = crossover(*gains.limit);
  for (const Crossover& each : gains.crossovers) result.crossovers.push_back(crossover(each));
  result.stable_intervals = std::move(gains.stable_intervals);
  result.trust = std::move(gains.trust);
  return result;
}

void refuse(CriticalDamping& result) {
  Trust trust = std::move(result.trust);
  result = {};
  result.status = StiffnessStatus::refused;
  result.damping = std::numeric_limits<double>::quiet_NaN();
  result.trust = std::move(trust);
}

int outside_above(const CriticalDamping& result, double damping) {
  int outside = 0;
  for (const DampingCrossover& each : result.crossovers) {
    if (each.damping < damping) outside += each.poles_leaving;
  }
  return outside;
}

/// The second route beside a finite limit, of dampers that a device may have.
void confirm(const Device& device, CriticalDamping& result) {
  if (result.status != StiffnessStatus::finite) return;
  const double above = result.damping * (1.0 + closeness);
  const std::pair<double, bool> claims[] = {{0.5 * result.damping, true},
                                            {result.damping * (1.0 - closeness), true},
                                            {above, outside_above(result, above) == 0}};
  for (const auto& [damping, stable] : claims) {
    if (!positive_numbers.contains(damping)) continue;
    const Device damped = with_damping(device, damping);
    distrust(agreement(PoleCount(damped), weak_spring(damped), stable), damping, result.trust);
    if (result.trust.refused()) return;
  }
}

}  // namespace

double internal::weak_spring(const Device& device) {
  constexpr double weak = 1e-9;  // of B/T: the pole near z = 1 is told from the circle, and no other moves
  return weak * device.parameters().wall.damping / device.loop().sampling_period;
}

CriticalDamping critical_damping(const Device& device) {
  if (has_damper_loop(device.loop())) return critical_damping(with_loop_of_damper(device));
  const FilteredPlant plant = filtered_plant(device);
  const VirtualDamper unit{1.0, device.parameters().wall.velocity_filter_hz};
  CriticalDamping result;
  try {
    result = as_damping(critical_stiffness_of(plant, damping_crossings(plant, unit)));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    result.trust.refuse({.code = FindingCode::not_converged, .subjects = {{"reason", error.what()}}});
  }
  result.trust.inherit(trust_of(device));
  if (!result.trust.refused()) confirm(device, result);
  if (result.trust.refused()) refuse(result);
  return result;
}

AbsoluteStabilityDamping absolute_stability_damping(const Device& device, const Progress& progress) {
  if (has_damper_loop(device.loop())) return absolute_stability_damping(with_loop_of_damper(device), progress);
  AbsoluteStabilitySearch search(device, progress);
  AbsoluteStabilityLimit limit = search.damping_limit(device.parameters().wall.velocity_filter_hz, progress);
  return {limit.stiffness, limit.frequency, limit.truncation, limit.needs_no_user, std::move(limit.trust)};
}

}  // namespace zwidth
