#include "stability/limit/two_rate_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "stability/limit/gain_crossings.hpp"
#include "stability/limit/guarded_stiffness.hpp"
#include "stability/limit/oscillator_at.hpp"
#include "stability/limit/stiffness_scan.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/quantity.hpp"

namespace zwidth::internal {
namespace {

// Where poles are followed over K: from so small a share of the softest wall that would be critical without the damper, to so
// large a multiple of the stiffest one.
constexpr double softest_share = 1e-6;
constexpr double stiffest_multiple = 100.0;

struct StiffnessRange {
  double least = 0.0;
  double most = 0.0;
};

StiffnessRange followed_range(const TwoRateDevice& loop) {
  const FilteredPlant plant = filtered_plant(loop.spring_alone(), {});
  const double at_mid_band = 1.0 / gain_at_mid_band(plant);
  StiffnessRange range{at_mid_band, at_mid_band};
  for (const GainCrossing& crossing : stiffness_crossings(plant, VirtualDamper{}).crossings) {
    range.least = std::min(range.least, crossing.gain);
    range.most = std::max(range.most, crossing.gain);
  }
  return {softest_share * range.least, stiffest_multiple * range.most};
}

CriticalStiffness with_damper_outside(const TwoRateDevice& loop, const ScheduledLoop& as_it_runs) {
  CriticalStiffness result;
  constexpr double most_states = 80.0;  // beyond, following their poles takes many seconds
  const auto states = static_cast<double>(as_it_runs.states());
  if (states > most_states) {
    result.trust.refuse(
        {.code = FindingCode::too_many_states_for_damper, .evidence = {{"states", states}, {"most", most_states}}});
    return result;
  }
  const StiffnessRange range = followed_range(loop);
  const ScannedCrossings found = scan_stiffness(as_it_runs, soft_stiffness(as_it_runs, range.least), range.most);
  const SampledPlant modes = loop.spring_alone();
  for (const ScannedCrossing& each : found.crossings) {
    const double frequency = as_it_runs.frequency_of(each.pole_minus_one, each.stiffness);
    const double angle = std::min(frequency * loop.spring().period, std::numbers::pi);
    result.crossovers.push_back({frequency, each.stiffness, oscillator_at(modes, angle), each.poles_leaving});
  }
  std::ranges::sort(result.crossovers, {}, &Crossover::frequency);
  find_limit(result, found.initially_unstable);
  return result;
}

CriticalStiffness found_stiffness(const TwoRateDevice& loop, const ScheduledLoop& as_it_runs) {
  if (!loop.is_damper_inside()) return with_damper_outside(loop, as_it_runs);
  const FilteredPlant plant = loop.seen_by_spring();
  return critical_stiffness_of(plant, stiffness_crossings(plant, VirtualDamper{}), loop.spring_alone());
}

// Where the loop is never stable the softest walls tell: crossovers lie anywhere above.
std::vector<Claim> claims_beside(const CriticalStiffness& critical, const TwoRateDevice& loop) {
  constexpr double soft = 1e-3;  // gain of the loop at mid band
  const double gain = gain_at_mid_band(filtered_plant(loop.spring_alone(), {}));
  std::vector<Claim> claims = claims_of(critical, gain);
  if (critical.status == StiffnessStatus::none_stable) {
    claims.resize(1);
    claims.front().stiffness = std::min(claims.front().stiffness, soft / gain);
  }
  return claims;
}

// Nothing where the other route cannot tell.
std::optional<bool> is_stable_by_other_route(const TwoRateDevice& loop, const ScheduledLoop& as_it_runs,
                                             double stiffness) {
  if (loop.is_damper_inside()) {
    const std::optional<int> outside = as_it_runs.unstable_poles(stiffness);
    return outside ? std::optional(*outside == 0) : std::nullopt;
  }
  try {
    const FilteredPlant plant = loop.seen_by_damper(stiffness);
    return unstable_poles(damping_crossings(plant, loop.gains()), loop.damper().damping) == 0;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    return std::nullopt;
  }
}

}  // namespace

TwoRateDevice::TwoRateDevice(const Device& device, double damping)
    : form_(modal_form(device)), spring_{device.loop().sampling_period, device.loop().delay} {
  const auto [period, delay] = damper_timing(device.loop());
  damper_ = {{period, delay}, damping, device.parameters().wall.velocity_filter_hz};
  is_damper_inside_ = damping == 0.0 || period < 1.5 * spring_.period;
}

SampledPlant TwoRateDevice::spring_alone() const { return sample(form_, spring_); }

FilteredPlant TwoRateDevice::seen_by_spring() const {
  return filtered_plant(damper_.damping > 0.0 ? sample_behind(form_, spring_, damper_) : spring_alone(), {});
}

FilteredPlant TwoRateDevice::seen_by_damper(double stiffness) const {
  InnerLoop spring;
  spring.sampling = spring_;
  spring.stiffness = stiffness;
  return filtered_plant(sample_behind(form_, damper_.sampling, spring), {});
}

ScheduledLoop TwoRateDevice::as_it_runs(const Device& device) const { return {state_space(device), spring_, damper_}; }

Agreement agreement(const TwoRateDevice& loop, const ScheduledLoop& as_it_runs, double stiffness, bool stable) {
  const std::optional<bool> other = is_stable_by_other_route(loop, as_it_runs, stiffness);
  if (!other) return Agreement::undecided;
  return *other == stable ? Agreement::agrees : Agreement::contradicts;
}

CriticalStiffness unguarded_stiffness(const Device& device) {
  if (!has_damper_loop(device.loop())) return critical_stiffness(filtered_plant(device), virtual_damper(device));
  const double damping = device.parameters().wall.damping;
  if (damping == 0.0) return unguarded_stiffness(with_one_rate(device));
  const TwoRateDevice loop(device, damping);
  return found_stiffness(loop, loop.as_it_runs(device));
}

CriticalStiffness two_rate_stiffness(const Device& device) {
  // Without its damper the device has one rate.
  if (device.parameters().wall.damping == 0.0) return critical_stiffness(with_one_rate(device));
  CriticalStiffness critical;
  std::optional<TwoRateDevice> loop;
  std::optional<ScheduledLoop> as_it_runs;
  try {
    loop.emplace(device, device.parameters().wall.damping);
    as_it_runs.emplace(loop->as_it_runs(device));
    critical = found_stiffness(*loop, *as_it_runs);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::did_not_converge) throw;
    critical.trust.refuse({.code = FindingCode::not_converged, .subjects = {{"reason", error.what()}}});
  }
  critical.trust.inherit(trust_of(device));
  if (!critical.trust.refused()) {
    for (const Claim& claim : claims_beside(critical, *loop)) {
      distrust(agreement(*loop, *as_it_runs, claim.stiffness, claim.stable), claim.stiffness, critical.trust);
      if (critical.trust.refused()) break;
    }
  }
  if (critical.trust.refused()) withdraw(critical);
  return critical;
}

Remark damper_closed_at_own_rate(const Device& device) {
  const double period = damper_timing(device.loop()).sampling_period;
  return note({.code = FindingCode::damper_closed_at_own_rate,
               .evidence = {{"damping", device.parameters().wall.damping, units_of(device.parameters().motion).damping},
                            {"rate_hz", 1.0 / period, "Hz"}},
               .key = "loop.damper.sampling_period"});
}

}  // namespace zwidth::internal
