// Random passive users against the absolute stability limit: extra bodies on springs and dampers, attached to the held body.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "property/property_cases.hpp"
#include "property/random_devices.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/worst_user.hpp"

namespace zwidth {
namespace {

constexpr std::size_t users_per_device = 20;
constexpr double rounding = 3e-6;  // of the limit towards w = 0, and of a K_CR with a user of widely spread values

std::size_t device_count() {
  constexpr std::size_t most = 10000;
  return std::max<std::size_t>(1, std::min(test::property_cases(2500), most) / users_per_device);
}

/// The device held by a network of up to three bodies (order 6) and a mass, damper and spring to ground.
Device with_random_user(const Device& device, test::RandomDevices& random) {
  DeviceParameters held = device.parameters();
  held.user = {};
  const double mass = held.bodies[held.loop.held].mass;
  const double speed = random.log_uniform(1.0, 3.0 / held.loop.sampling_period);  // rad/s, of its resonances
  if (random.chance(0.7)) held.user.mass = mass * random.log_uniform(1e-2, 1e3);
  if (random.chance(0.3)) held.user.damping = random.log_uniform(1e-3, 1e2);
  if (random.chance(0.7)) held.user.stiffness = mass * speed * speed * random.log_uniform(1e-2, 1e2);
  std::size_t last = held.loop.held;
  const std::size_t bodies = random.index(4);
  for (std::size_t i = 0; i < bodies; ++i) {
    held.bodies.push_back({"user" + std::to_string(i), mass * random.log_uniform(1e-2, 1e2),
                           random.chance(0.3) ? random.log_uniform(1e-3, 1e2) : 0.0, 0.0, 0.0});
    const double stiffness = held.bodies.back().mass * speed * speed * random.log_uniform(0.1, 10.0);
    held.links.push_back({random.chance(0.5) ? last : held.loop.held, held.bodies.size() - 1, stiffness,
                          random.chance(0.4) ? stiffness / speed * random.log_uniform(1e-4, 1.0) : 0.0});
    last = held.bodies.size() - 1;
  }
  return Device(std::move(held));
}

/// A mode that the device hardly moves: whether its poles lie inside the circle is below rounding.
bool has_unresolved_mode(const Device& device) {
  const ModalForm form = modal_form(device);
  return std::any_of(form.modes.begin(), form.modes.end(), [&](const Mode& mode) {
    return mode.damping_ratio * mode.frequency * device.loop().sampling_period < 1e-12;
  });
}

/// What makes the limit hard to find: links that only dissipate, lags longer than all else, hardly any damping, bodies
/// without any.
void make_hard(DeviceParameters& device, std::size_t how, test::RandomDevices& random) {
  switch (how % 4) {
    case 0:
      for (Link& link : device.links)
        link = {link.first, link.second, 0.0, link.damping * random.log_uniform(0.1, 1e3)};
      break;
    case 1:
      device.actuator.time_constant = random.log_uniform(3e-3, 30.0);
      break;
    case 2:
      for (Body& body : device.bodies) body.damping *= random.log_uniform(1e-4, 1.0);
      break;
    default:
      for (Body& body : device.bodies) body.damping *= random.chance(0.5) ? 0.0 : 1.0;
      device.wall.damping = random.log_uniform(0.01, 10.0);
  }
}

TEST(AbsoluteStabilityProperty, NoPassiveUserDestabilisesAHardDeviceBelowTheLimit) {
  std::size_t tried = 0;
  std::size_t refused = 0;
  for (std::size_t seed = 0; seed < device_count(); ++seed) {
    test::RandomDevices random(seed + 4400);
    DeviceParameters parameters = random.device(test::device_kinds[seed % test::reference_kinds]);
    parameters.user = {};
    make_hard(parameters, seed, random);
    const Device device(parameters);
    const VirtualDamper damper{parameters.wall.damping, parameters.wall.velocity_filter_hz};
    const AbsoluteStabilityLimit limit = absolute_stability_limit(device, damper);
    if (!(limit.stiffness > 0.0) || !std::isfinite(limit.stiffness)) continue;
    for (std::size_t i = 0; i < users_per_device; ++i) {
      DeviceParameters heavy = parameters;  // every other user: ever heavier, who reach a limit at w -> 0
      heavy.user.mass = random.log_uniform(1.0, 1e8);
      const Device held = i % 2 == 0 ? Device(heavy) : with_random_user(device, random);
      if (has_unresolved_mode(held)) continue;
      ++tried;
      SCOPED_TRACE(std::string(test::device_kinds[seed % test::reference_kinds]) + ", seed " + std::to_string(seed) +
                   ", user " + std::to_string(i));
      EXPECT_GE(critical_stiffness(filtered_plant(held), damper).stiffness, limit.stiffness * (1.0 - rounding));
      const CriticalStiffness guarded = critical_stiffness(held);
      EXPECT_TRUE(guarded.trust.refused() || guarded.stiffness >= limit.stiffness * (1.0 - rounding));
      if (guarded.trust.refused()) ++refused;
    }
  }
  EXPECT_GT(tried, device_count() * users_per_device / 4);
  RecordProperty("refused", std::to_string(refused));
  EXPECT_LE(refused, tried / 100);
}

TEST(AbsoluteStabilityProperty, NoPassiveUserDestabilisesAWallBelowTheLimit) {
  double closest = 1e300;
  std::size_t tried = 0;
  for (std::size_t seed = 0; seed < device_count(); ++seed) {
    test::RandomDevices random(seed + 77);
    // wall_filter, the last kind, besides those of the reference data
    const std::size_t number = seed % (test::reference_kinds + 1);
    const auto kind = number < test::reference_kinds ? test::device_kinds[number] : test::device_kinds.back();
    DeviceParameters parameters = random.device(kind);
    parameters.user = {};
    const Device device(parameters);
    const VirtualDamper damper{parameters.wall.damping, parameters.wall.velocity_filter_hz};
    const AbsoluteStabilityLimit limit = absolute_stability_limit(device, damper);
    if (!(limit.stiffness > 0.0) || !std::isfinite(limit.stiffness)) continue;
    for (std::size_t i = 0; i < users_per_device; ++i) {
      const Device held = with_random_user(device, random);
      if (has_unresolved_mode(held)) continue;
      ++tried;
      const double critical = critical_stiffness(filtered_plant(held), damper).stiffness;
      closest = std::min(closest, critical / limit.stiffness);
      EXPECT_GE(critical, limit.stiffness * (1.0 - rounding)) << kind << ", seed " << seed << ", user " << i;
    }
  }
  EXPECT_GT(tried, device_count() * users_per_device * 8 / 10);
  RecordProperty("closest", std::to_string(closest));
  EXPECT_LT(closest, 1.05);  // the users are not so mild that the property says nothing
}

// The worst user of random devices, by closed-loop eigenvalues: stable just below the limit, unstable just above what
// was found, and that within 1e-4 of the limit but for a few: rigid devices whose delay is no whole number of samples.
TEST(AbsoluteStabilityProperty, TheWorstUserProvesTheLimitTight) {
  std::size_t judged = 0;
  std::size_t tight = 0;
  for (std::size_t seed = 0; seed < 100; ++seed) {
    test::RandomDevices random(seed + 77);
    const auto kind = test::device_kinds[seed % test::device_kinds.size()];
    const DeviceParameters parameters = random.device(kind);
    if (parameters.transfer_function) continue;
    const Device device(parameters);
    const VirtualDamper damper{parameters.wall.damping, parameters.wall.velocity_filter_hz};
    const AbsoluteStabilityLimit limit = absolute_stability_limit(device, damper);
    const auto worst = worst_user(device, limit, damper);
    if (!worst) continue;
    ++judged;
    EXPECT_GE(worst->critical_stiffness, limit.stiffness * (1.0 - 1e-9)) << kind << ", seed " << seed;
    EXPECT_LE(worst->critical_stiffness, limit.stiffness * 1.04) << kind << ", seed " << seed;
    if (worst->critical_stiffness <= limit.stiffness * 1.0001) ++tight;
    const Device held = held_by(device, worst->user);
    const DiscreteStateSpace plant = sample(state_space(held), {held.loop().sampling_period, held.loop().delay});
    Wall wall = parameters.wall;
    wall.stiffness = worst->critical_stiffness * 1.0001;
    EXPECT_GT(stability_excess(plant, wall), 0.0) << kind << ", seed " << seed;
    wall.stiffness = limit.stiffness * 0.9999;
    EXPECT_LT(stability_excess(plant, wall), 0.0) << kind << ", seed " << seed;
  }
  EXPECT_GE(judged, 85U);
  EXPECT_GE(tight, judged * 9 / 10) << judged;
}

}  // namespace
}  // namespace zwidth
