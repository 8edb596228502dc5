#include "design/synthesis/damper_limits.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "design/sensitivities/number_limit.hpp"
#include "design/synthesis/wall_limits.hpp"
#include "infinity.hpp"
#include "model/known_structure.hpp"
#include "staged_progress.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/quantity.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth::internal {
namespace {

constexpr double damper_shaved = 1e-6;  // off every limit
constexpr double margin_rounding = 1e-9;
constexpr double weaker = 0.8;  // the walk to a damper that keeps the phase margin
constexpr int most_weaker = 120;
constexpr int damper_bisections = 40;
constexpr double grows = 1e-8;                                        // |z| - 1
constexpr std::array users_masses{0.0, 0.1, 1.0, 10.0, 1e3};          // times the device's
constexpr std::array users_springs{0.0, 1e-4, 1e-2, 0.1, 1.0, 10.0};  // times B/T

double found_damping(const CriticalDamping& critical) {
  if (critical.trust.refused()) throw Error(ErrorCode::did_not_converge, critical.trust.reasons.front());
  return critical.damping;
}

/// No pole outside the circle but that of a position that nothing holds.
bool comes_to_rest(const Device& device) {
  const DiscreteStateSpace sampled = sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
  const CountedPoles counted =
      is_position_free(device.parameters()) ? CountedPoles::but_free_position : CountedPoles::all;
  return stability_excess(sampled, device.parameters().wall, counted) <= grows;
}

}  // namespace

double DamperLimits::limit(double velocity_filter_hz, bool& of_users) const {
  const Device filtered = with_wall(device_, 0.0, {0.0, velocity_filter_hz});
  double least = std::min(found_damping(critical_damping(filtered)),
                          found_damping(critical_damping(device_without_user(filtered))));
  of_users = false;
  if (!can_be_held(device_)) return least;
  const AbsoluteStabilityDamping users = absolute_stability_damping(filtered, options_.progress);
  if (users.trust.refused()) throw Error(ErrorCode::did_not_converge, users.trust.reasons.front());
  of_users = users.damping <= least;
  return std::min(least, users.damping);
}

bool DamperLimits::keeps_phase(VirtualDamper damper) const {
  tell(options_.progress, 0.0);
  const auto keeps = [&](const Device& walled) {
    const LoopMargins has = loop_margins(filtered_plant(walled), walled.parameters().wall);
    return has.phase_margin.value_or(std::numbers::pi) >= options_.phase_margin * (1.0 - margin_rounding);
  };
  const Device walled = with_wall(device_, 0.0, damper);
  return keeps(walled) && (!device_has_user(walled) || keeps(device_without_user(walled)));
}

bool DamperLimits::keeps(VirtualDamper damper) const {
  bool of_users = false;
  const double most = limit(damper.velocity_filter_hz, of_users);
  return options_.gain_margin * damper.damping <= most * (1.0 + margin_rounding) && keeps_phase(damper);
}

DamperLimits::Strongest DamperLimits::strongest(double velocity_filter_hz) const {
  tell(options_.progress, 0.0);
  bool of_users = false;
  const double most = limit(velocity_filter_hz, of_users) / options_.gain_margin;
  Strongest strongest{most * (1.0 - damper_shaved), of_users ? WallBound::any_user : WallBound::gain_margin};
  const double resolution = device_.parameters().sensor.resolution;
  if (options_.quantisation_force && resolution > 0.0) {
    const Wall wall = with_wall(device_, 0.0, {0.0, velocity_filter_hz}).parameters().wall;
    const double quiet = *options_.quantisation_force /
                         force_per_count_rates(wall, device_.loop().sampling_period, resolution).per_damping;
    if (quiet < strongest.damping) strongest = {quiet * (1.0 - damper_shaved), WallBound::quantisation_force};
  }
  if (!std::isfinite(strongest.damping)) return {infinity, WallBound::none};
  if (strongest.damping == 0.0 || keeps_phase({strongest.damping, velocity_filter_hz})) return strongest;
  double high = strongest.damping;
  double low = 0.0;
  for (int i = 0; i < most_weaker && low == 0.0; ++i) {
    const double next = weaker * high;
    (keeps_phase({next, velocity_filter_hz}) ? low : high) = next;
  }
  for (int i = 0; i < damper_bisections && low > 0.0; ++i) {
    const double middle = 0.5 * (low + high);
    (keeps_phase({middle, velocity_filter_hz}) ? low : high) = middle;
  }
  return {low, WallBound::phase_margin};
}

void DamperLimits::check(VirtualDamper damper, Trust& trust) const {
  const double mass = moving_mass(device_);
  const double grown = options_.gain_margin * damper.damping;
  const Device walled = with_wall(device_, 0.0, {grown, damper.velocity_filter_hz});
  const double spring = grown / device_.loop().sampling_period;
  for (const double heavy : users_masses) {
    for (const double stiff : users_springs) {
      tell(options_.progress, 0.0);
      DeviceParameters held = walled.parameters();
      if (can_be_held(device_)) held.user = {heavy * mass, 0.0, stiff * spring};
      if (find_problem(held) || comes_to_rest(Device(std::move(held)))) continue;
      Finding finding{.code = FindingCode::damper_contradicts, .evidence = {{"damping", grown}}};
      if (heavy > 0.0 || stiff > 0.0) {
        finding.code = FindingCode::damper_contradicts_with_user;
        finding.evidence = {{"damping", grown}, {"user_mass_ratio", heavy}, {"user_spring_ratio", stiff}};
      }
      trust.refuse(std::move(finding));
      return;
    }
  }
}

}  // namespace zwidth::internal
