#include "design/synthesis/wall_limits.hpp"

#include <algorithm>
#include <complex>
#include <numbers>
#include <utility>

#include "design/synthesis/margin_wall.hpp"
#include "infinity.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth::internal {
namespace {

constexpr double shaved = 1e-6;    // off every limit
constexpr double rounding = 1e-9;  // of margins that stand exactly at what is required
constexpr double same = 1e-4;      // relative, of a margin that is the one that bounds
constexpr double critical_ratio = 1.0 - 1e-6;
constexpr int limit_bisections = 40;
constexpr double softest = 1e-9;  // of the limit, before a contact counts as never damped

VirtualDamper scaled(VirtualDamper damper, double factor) {
  return {factor * damper.damping, damper.velocity_filter_hz};
}

Wall wall_of(const Device& device, double stiffness, VirtualDamper damper) {
  Wall wall = device.parameters().wall;
  wall.stiffness = stiffness;
  wall.damping = damper.damping;
  wall.velocity_filter_hz = damper.velocity_filter_hz;
  return wall;
}

/// Least damping ratio of the poles up to twice sqrt((K + k)/m); nothing where there are none.
std::optional<double> least_ratio(const Device& device, const DiscreteStateSpace& system, const Wall& wall) {
  const User& user = device.parameters().user;
  double mass = user.mass;
  double stiffness = *wall.stiffness + user.stiffness;
  for (const Body& body : device.bodies()) {
    mass += body.mass;
    stiffness += body.stiffness;
  }
  const double highest = 2.0 * std::sqrt(stiffness / mass);
  std::optional<double> least;
  for (const std::complex<double>& delta : closed_loop_poles_minus_one(system, wall)) {
    // ln(1 + delta), with its digits where delta is small
    const double growth = 0.5 * std::log1p(2.0 * delta.real() + std::norm(delta));
    const std::complex<double> s(growth / system.period, std::arg(1.0 + delta) / system.period);
    if (!(std::abs(s) <= highest) || std::abs(s) == 0.0) continue;
    least = std::min(least.value_or(1.0), -s.real() / std::abs(s));
  }
  return least;
}

}  // namespace

Device with_wall(const Device& device, double stiffness, VirtualDamper damper) {
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty.reset();
  parameters.wall = wall_of(device, stiffness, damper);
  return Device(std::move(parameters));
}

Device with_filter(const Device& device, const WallFilter& filter) {
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty.reset();
  parameters.wall.filters.push_back(filter);
  return Device(std::move(parameters));
}

bool can_be_held(const Device& device) {
  return device.has_bodies() && device.bodies().size() <= most_bodies_for_absolute_stability;
}

WallLimits::WallLimits(const Device& device, const RecommendationOptions& options)
    : device_(device),
      options_(options),
      plants_{filtered_plant(device)},
      system_(sample(state_space(device), {device.loop().sampling_period, device.loop().delay})) {
  tell(options.progress, 0.0);
  if (device_has_user(device)) plants_.push_back(filtered_plant(device_without_user(device)));
  if (can_be_held(device)) users_ = std::make_unique<AbsoluteStabilitySearch>(device, options.progress);
}

double WallLimits::limit(VirtualDamper damper) {
  tell(options_.progress, 0.0);
  return users_ ? users_->limit(damper, options_.progress).stiffness
                : critical_stiffness(plants_.front(), damper).stiffness;
}

bool WallLimits::loop_keeps(double stiffness, VirtualDamper damper) const {
  tell(options_.progress, 0.0);
  const Wall wall = wall_of(device_, stiffness, damper);
  return std::ranges::all_of(plants_, [&](const FilteredPlant& plant) {
    const LoopMargins has = loop_margins(plant, wall);
    return has.stable && has.gain_margin.value_or(infinity) >= options_.gain_margin * (1.0 - rounding) &&
           has.stiffness_margin.value_or(infinity) >= options_.gain_margin * (1.0 - rounding) &&
           has.lower_gain_margin.value_or(0.0) * options_.gain_margin <= 1.0 + rounding &&
           has.phase_margin.value_or(std::numbers::pi) >= options_.phase_margin * (1.0 - rounding);
  });
}

bool WallLimits::keeps(double stiffness, VirtualDamper damper) {
  const double gain = options_.gain_margin;
  for (const double factor : {1.0, std::sqrt(gain), gain}) {
    const double grown = factor == 1.0 ? gain : factor;
    if (grown * stiffness >= limit(scaled(damper, factor)) * (1.0 + rounding)) return false;
  }
  return loop_keeps(stiffness, damper);
}

WallLimits::Stiffest WallLimits::stiffest(VirtualDamper damper, WallGoal goal) {
  Stiffest least{infinity, WallBound::none};
  const auto take = [&least](double stiffness, WallBound bound) {
    if (stiffness < least.stiffness) least = {stiffness, bound};
  };
  const double gain = options_.gain_margin;
  const WallBound by_gain = users_ ? WallBound::any_user : WallBound::gain_margin;
  take(limit(damper) / gain, by_gain);
  if (damper.damping > 0.0) {
    for (const double factor : {std::sqrt(gain), gain}) {
      if (least.stiffness > 0.0) take(limit(scaled(damper, factor)) / factor, by_gain);
    }
  }
  const double resolution = device_.parameters().sensor.resolution;
  if (options_.quantisation_force && resolution > 0.0) {
    const ForcePerCountRates rates = force_per_count_rates(wall_of(device_, 0.0, damper), system_.period, resolution);
    take(std::max(0.0, *options_.quantisation_force - damper.damping * rates.per_damping) / rates.per_stiffness,
         WallBound::quantisation_force);
  }
  if (!(least.stiffness > 0.0) || !std::isfinite(least.stiffness)) return least;
  least.stiffness *= 1.0 - shaved;
  const auto keep_margins = [&] {
    if (loop_keeps(least.stiffness, damper)) return;
    const RequiredMargins margins{gain, options_.phase_margin, false};
    for (const FilteredPlant& plant : plants_) {
      const double kept = stiffest_wall(plant, damper, margins, {.at_most = least.stiffness}, options_.progress);
      least.stiffness = std::min(least.stiffness, kept * (1.0 - shaved));
    }
    const bool phase = std::ranges::any_of(plants_, [&](const FilteredPlant& plant) {
      const LoopMargins has = loop_margins(plant, wall_of(device_, least.stiffness, damper));
      return has.phase_margin && *has.phase_margin <= options_.phase_margin * (1.0 + same) + shaved;
    });
    least.bound = phase || least.stiffness == 0.0 ? WallBound::phase_margin : WallBound::gain_margin;
    if (!(least.stiffness > 0.0) || !loop_keeps(least.stiffness, damper)) least.stiffness = 0.0;
  };
  keep_margins();
  if (goal == WallGoal::critical_damping && least.stiffness > 0.0) {
    if (contact_damping(least.stiffness, damper) < critical_ratio) {
      least = critically_damped(least.stiffness, damper);
      if (least.stiffness > 0.0) keep_margins();
    }
  }
  return least;
}

WallLimits::Stiffest WallLimits::critically_damped(double at_most, VirtualDamper damper) const {
  double low = softest * at_most;
  double high = at_most;
  if (contact_damping(low, damper) < critical_ratio) return {0.0, WallBound::contact_damping};
  for (int i = 0; i < limit_bisections; ++i) {
    const double middle = std::sqrt(low * high);
    (contact_damping(middle, damper) < critical_ratio ? high : low) = middle;
  }
  return {low, WallBound::contact_damping};
}

double WallLimits::contact_damping(double stiffness, VirtualDamper damper) const {
  return least_ratio(device_, system_, wall_of(device_, stiffness, damper)).value_or(1.0);
}

}  // namespace zwidth::internal

namespace zwidth {

std::optional<double> contact_damping_ratio(const Device& device) {
  const Wall& wall = device.parameters().wall;
  if (!device.has_bodies() || !(wall.stiffness.value_or(0.0) > 0.0)) return std::nullopt;
  if (has_damper_loop(device.loop())) return std::nullopt;
  return internal::least_ratio(device,
                               sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), wall);
}

}  // namespace zwidth
