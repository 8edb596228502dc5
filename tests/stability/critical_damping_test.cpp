// Dampers without a spring. Beside critical_damping() and absolute_stability_damping(): closed forms of a rigid device, eigenvalues of
// the matrix exponential, and users.

#include "zwidth/stability/critical_damping.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <string_view>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/design/absolute_stability_region.hpp"
#include "zwidth/design/stable_region.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

DeviceParameters one_body(double mass, double damping, double period) {
  DeviceParameters device;
  device.bodies = {{"body", mass, damping, 0.0, 0.0}};
  device.loop = {0, 0, 0, period, 0.0};
  return device;
}

/// Of z (z - a) + (B/T) (c1 z + c0), a = e^{-bT/m}, by Jury: the loop of a rigid device and a damper, no delay.
double critical_damping_of_rigid(double m, double b, double T) {
  const double a = std::exp(-b * T / m);
  const double travelled = -std::expm1(-b * T / m) * m / (b * b);
  const double c1 = T / b - travelled;
  const double c0 = travelled - a * T / b;
  return T * std::min(1.0 / c0, c1 > c0 ? (1.0 + a) / (c1 - c0) : std::numeric_limits<double>::infinity());
}

/// Largest |z| - 1 at K = 0 with this damper, but the pole of the position that nothing holds.
double damped_excess(const Device& device, double damping) {
  const Sampling sampling{device.loop().sampling_period, device.loop().delay};
  Wall wall = device.parameters().wall;
  wall.stiffness = 0.0;
  wall.damping = damping;
  return stability_excess(sample(state_space(device), sampling), wall, CountedPoles::but_free_position);
}

TEST(CriticalDamping, OfARigidDeviceHasAClosedForm) {
  test::RandomDevices random(1);
  for (int i = 0; i < 200; ++i) {
    const double T = random.log_uniform(1e-4, 1e-2);
    const double m = random.log_uniform(1e-3, 10.0);
    const double b = m / T * random.log_uniform(1e-4, 3.0);
    const CriticalDamping found = critical_damping(Device(one_body(m, b, T)));
    ASSERT_TRUE(found.trust.sound()) << i;
    ASSERT_EQ(found.status, StiffnessStatus::finite) << i;
    EXPECT_NEAR(found.damping / critical_damping_of_rigid(m, b, T), 1.0, 1e-9) << i;
    EXPECT_EQ(found.limit->limited_by.kind, Oscillator::Kind::rigid_body);
  }
}

// Colgate and Schenkel: b > K T/2 + B with a user of any kind.
TEST(CriticalDamping, WithAnyUserARigidDeviceBearsItsOwnDamping) {
  test::RandomDevices random(2);
  for (int i = 0; i < 50; ++i) {
    const double T = random.log_uniform(1e-4, 1e-2);
    const double m = random.log_uniform(1e-3, 10.0);
    const double b = m / T * random.log_uniform(1e-4, 0.1);
    const AbsoluteStabilityDamping found = absolute_stability_damping(Device(one_body(m, b, T)));
    EXPECT_TRUE(found.trust.sound());
    EXPECT_NEAR(found.damping / b, 1.0, 1e-6) << i;
    EXPECT_LE(found.damping, b * (1.0 + 1e-9)) << i;
  }
}

TEST(CriticalDamping, OfARotorWithADelay) {
  DeviceParameters device = one_body(2e-6, 2e-5, 1e-3);
  device.motion = Motion::rotary;
  device.loop.delay = 1e-3;
  const CriticalDamping found = critical_damping(Device(device));
  ASSERT_TRUE(found.limit);
  EXPECT_LT(found.damping, 0.006);
  EXPECT_LT(damped_excess(Device(device), found.damping * (1.0 - 1e-6)), 0.0);
  EXPECT_GT(damped_excess(Device(device), found.damping * (1.0 + 1e-6)), 0.0);
  device.wall.stiffness = 0.0;
  device.wall.damping = 0.006;
  const WallMargins wall = wall_margins(Device(device));
  EXPECT_FALSE(wall.stable);
  EXPECT_NEAR(wall.spectral_radius, 1.569, 5e-4);
  const auto poles = closed_loop_poles_minus_one(sample(state_space(Device(device)), {1e-3, 1e-3}), device.wall);
  const auto largest = *std::ranges::max_element(poles, {}, [](auto delta) { return std::abs(1.0 + delta); });
  EXPECT_NEAR(std::abs(std::arg(1.0 + largest)) / (2.0 * std::numbers::pi * 1e-3), 165.1, 0.05);
}

TEST(CriticalDamping, AFreePositionIsNoInstability) {
  DeviceParameters device = one_body(0.05, 0.01, 1e-3);
  device.wall.stiffness = 0.0;
  device.wall.damping = 0.5;
  const WallMargins wall = wall_margins(Device(device));
  EXPECT_TRUE(wall.stable);
  EXPECT_LT(wall.spectral_radius, 1.0);
  ASSERT_TRUE(wall.gain_margin);
  EXPECT_NEAR(*wall.gain_margin * 0.5 / critical_damping_of_rigid(0.05, 0.01, 1e-3), 1.0, 1e-9);
}

// Poles by the matrix exponential on both sides of every limit.
TEST(CriticalDamping, EigenvaluesAgreeOnRandomDevices) {
  int finite = 0;
  for (std::size_t seed = 0; seed < 210; ++seed) {
    test::RandomDevices random(seed + 700);
    const std::string_view kind = test::device_kinds[seed % test::device_kinds.size()];
    DeviceParameters parameters = random.device(kind);
    parameters.wall.damping = 0.0;
    if (parameters.transfer_function) continue;
    const Device device(parameters);
    const CriticalDamping found = critical_damping(device);
    if (!found.trust.sound() || found.status != StiffnessStatus::finite) continue;
    const double below = damped_excess(device, 0.999 * found.damping);
    const double above = damped_excess(device, 1.001 * found.damping);
    constexpr double rounding = 1e-9;
    EXPECT_LT(below, rounding) << kind << ", seed " << seed;
    if (found.limit->poles_leaving > 0) {
      EXPECT_GT(above, -rounding) << kind << ", seed " << seed;
    }
    ++finite;
  }
  EXPECT_GT(finite, 100);
}

TEST(CriticalDamping, WithAnyUserIsWhereTheRegionEnds) {
  const Device device(test::lhifam_parameters());
  const AbsoluteStabilityDamping found = absolute_stability_damping(device);
  const StableWalls walls(filtered_plant(device));
  const AbsoluteStabilityRegion region = absolute_stability_region(device, walls, critical_damping(device).damping);
  ASSERT_TRUE(region.most_damped);
  EXPECT_NEAR(region.most_damped->damping / found.damping, 1.0, 1e-3);
}

/// The least largest damper over lossless and damped users, none of whom may leave less than the limit.
double least_over_users(const Device& device, double limit) {
  test::RandomDevices random(3);
  double least = critical_damping(device).damping;
  const auto take = [&](const User& user) {
    const CriticalDamping held = critical_damping(device_with_user(device, user));
    if (!held.trust.sound()) return;
    EXPECT_GE(held.damping, limit * (1.0 - 1e-6)) << user.mass << ", " << user.damping << ", " << user.stiffness;
    least = std::min(least, held.damping);
  };
  for (int i = 0; i <= 60; ++i) {
    for (int j = 0; j <= 60; ++j) {
      take({i > 0 ? 1e-4 * std::pow(10.0, i / 8.0) : 0.0, 0.0, j > 0 ? std::pow(10.0, j / 7.0) : 0.0});
    }
  }
  for (int i = 0; i < 500; ++i) {
    take({random.log_uniform(1e-3, 1e3), random.log_uniform(1e-2, 1e3), random.log_uniform(1e2, 1e8)});
  }
  return least;
}

// No user needs less, and some mass on a spring hardly more: where the handle is sensed a quarter of what nobody leaves.
TEST(CriticalDamping, UsersProveTheLimit) {
  const DeviceParameters lhifam = test::lhifam_parameters();
  const DeviceParameters devices[] = {lhifam, test::handle_sensed(lhifam), test::with_delay(lhifam, 1e-3)};
  for (const DeviceParameters& each : devices) {
    const Device device(each);
    const double limit = absolute_stability_damping(device).damping;
    EXPECT_LT(limit, critical_damping(device).damping);
    const double least = least_over_users(device, limit);
    EXPECT_LT(least, limit * 1.002);
  }
}

}  // namespace
}  // namespace zwidth
