#include "design/synthesis/wall_limits.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <utility>

#include "infinity.hpp"
#include "stability/second_route/pole_modulus.hpp"
#include "staged_progress.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth::internal {
namespace {

constexpr double critical_ratio = 1.0 - 1e-6;
constexpr int limit_bisections = 40;
constexpr double softest = 1e-9;  // of the limit, before a contact counts as never damped

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
    const std::complex<double> s(log_modulus(delta) / system.period, std::arg(1.0 + delta) / system.period);
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
  return device.is_mechanical() && device.degrees_of_freedom() <= most_bodies_for_absolute_stability;
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
  if (!users_) return critical_stiffness(plants_.front(), damper).stiffness;
  const AbsoluteStabilityLimit limit = users_->limit(damper, options_.progress);
  misses_a_limit_ |= limit.trust.refused();
  return limit.lower_bound();
}

bool WallLimits::keeps(double stiffness, VirtualDamper damper) {
  const auto limit_with = [this](VirtualDamper each) { return limit(each); };
  return keeps_gain(limit_with, stiffness, damper, options_.gain_margin) &&
         keeps_margins(plants_, stiffness, damper, options_);
}

BoundedStiffness WallLimits::stiffest(VirtualDamper damper, WallGoal goal) {
  BoundedStiffness least{infinity, WallBound::none};
  const auto limit_with = [this](VirtualDamper each) { return limit(each); };
  bound_by_gain(limit_with, damper, options_.gain_margin, users_ ? WallBound::any_user : WallBound::gain_margin, least);
  bound_by_quantisation(device_, system_.period, damper, options_, least);
  if (!(least.stiffness > 0.0) || !std::isfinite(least.stiffness)) return least;
  least.stiffness *= 1.0 - off_every_limit;
  bound_by_margins(plants_, damper, options_, least);
  if (goal == WallGoal::critical_damping && least.stiffness > 0.0) {
    if (contact_damping(least.stiffness, damper) < critical_ratio) {
      least = critically_damped(least.stiffness, damper);
      if (least.stiffness > 0.0) bound_by_margins(plants_, damper, options_, least);
    }
  }
  return least;
}

BoundedStiffness WallLimits::critically_damped(double at_most, VirtualDamper damper) const {
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
