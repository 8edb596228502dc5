// Limits over all passive users that a scan over frequency missed or got from rounding: reached towards zero frequency
// beside something very slow, with links that only dissipate, and where only links dissipate. Expected values: the
// discs from the device matrices with 40 digits, aliases summed one by one to 192 and extrapolated (mpmath).

#include <gtest/gtest.h>

#include <cmath>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

DeviceParameters two_bodies(Body first, Body second, Link link, Loop loop) {
  DeviceParameters device;
  device.bodies = {std::move(first), std::move(second)};
  device.links = {link};
  device.loop = loop;
  return device;
}

double limit_of(const DeviceParameters& parameters) {
  const AbsoluteStabilityLimit limit =
      absolute_stability_limit(Device(parameters), {parameters.wall.damping, parameters.wall.velocity_filter_hz});
  EXPECT_TRUE(limit.trust.sound());
  return limit.stiffness;
}

// The scan's lowest frequency, 1e-7 rad per sample, allows 0.0353: 163 times too much.
TEST(AbsoluteStabilityTowardsZero, IsFoundBelowAnyScannedFrequencyBesideASlowLink) {
  DeviceParameters device =
      two_bodies({"motor", 0.71589814376285632, 0.091061843352531771, 0.0, 0.0},
                 {"handle", 0.67295281472855517, 4.1096615561872429, 0.0, 0.0},
                 {0, 1, 0.00021202701763375843, 24.95434006326537}, {1, 0, 0, 0.001, 0.00093664187414881767});
  EXPECT_NEAR(limit_of(device), 0.0002167250943, 1e-9 * 0.0002);
  EXPECT_EQ(absolute_stability_limit(Device(device)).frequency, 0.0);

  device = two_bodies({"motor", 0.27207874327937787, 0.68638228442955096, 0.0, 0.0},
                      {"handle", 0.19096698952592303, 0.53791079898624539, 0.0, 0.0},
                      {0, 1, 0.00073455779441263143, 27.59644682128674}, {1, 0, 0, 0.001, 0.0});
  EXPECT_NEAR(limit_of(device), 0.00167186346661, 1e-9 * 0.0017);
}

// A very heavy user, by critical stiffness: nowhere below the limit, and close to it.
TEST(AbsoluteStabilityTowardsZero, HeavyUsersComeNearIt) {
  for (const double lag : {0.3, 3.0}) {
    DeviceParameters device = test::lhifam_parameters();
    device.actuator.time_constant = lag;
    const double limit = limit_of(device);
    double closest = 1e300;
    for (const double mass : {1e4, 1e6, 1e8, 1e10}) {
      device.user.mass = mass;
      const double critical = critical_stiffness(filtered_plant(Device(device)), {}).stiffness;
      EXPECT_GE(critical, limit * (1.0 - 1e-9)) << lag << ", " << mass;
      closest = std::min(closest, critical);
    }
    EXPECT_LT(closest, limit * (1.0 + 1e-5)) << lag;
  }
}

// Only the link and the virtual damper dissipate. The scan answered 5564.5, 0 and 0: rounding of discs that grow as
// w^-5.
TEST(AbsoluteStabilityTowardsZero, IsNotRoundingWhereOnlyLinksDissipate) {
  DeviceParameters device =
      two_bodies({"motor", 0.037631718415801693, 0.0, 0.0, 0.0}, {"handle", 7.1649870905687898, 0.0, 0.0, 0.0},
                 {0, 1, 38049.886907848937, 1.999771369610754}, {0, 0, 1, 0.001, 6.8823898145332508e-05});
  device.wall.damping = 5.6097778439595567;
  EXPECT_NEAR(limit_of(device), 6782.87033648, 1e-8 * 6783.0);

  device = two_bodies({"motor", 0.16913386657344895, 0.0, 0.0, 0.0},
                      {"handle", 0.064798177696237594, 0.0, 1.2798636512698245, 0.0},
                      {0, 1, 53247.97304430385, 0.23060564140235998}, {0, 0, 1, 0.001, 0.0});
  device.wall.damping = 0.01338235025454731;
  EXPECT_NEAR(limit_of(device), 26.7529650747, 1e-9 * 27.0);

  device = two_bodies({"motor", 0.82730065955421817, 0.0, 0.0, 0.0},
                      {"handle", 2.6127141428929064, 0.0, 10.036231710705446, 0.0},
                      {0, 1, 1894336.2197666094, 45.04208019832879}, {0, 0, 1, 0.001, 0.0});
  device.wall.damping = 0.021769932820033869;
  EXPECT_NEAR(limit_of(device), 43.5318251745, 1e-9 * 44.0);
}

// Colgate & Schenkel's limit is the same at all frequencies without a damper; with one it is least at Nyquist.
TEST(AbsoluteStabilityTowardsZero, ARigidDeviceNamesZeroFrequency) {
  EXPECT_EQ(absolute_stability_limit(Device(test::rigid_parameters())).frequency, 0.0);
  EXPECT_NEAR(absolute_stability_limit(Device(test::rigid_parameters()), {1.0, 0.0}).frequency, 3141.5927, 0.01);
}

// Wherever it is reached: what may be left is small for ordinary devices, and taken off.
TEST(AbsoluteStabilityTowardsZero, WhatIsLeftOpenIsSmall) {
  for (std::size_t seed = 0; seed < 210; ++seed) {
    const auto kind = test::device_kinds[seed % test::device_kinds.size()];
    const DeviceParameters parameters = test::RandomDevices(seed + 910000).device(kind);
    if (parameters.transfer_function) continue;
    const AbsoluteStabilityLimit limit =
        absolute_stability_limit(Device(parameters), {parameters.wall.damping, parameters.wall.velocity_filter_hz});
    EXPECT_LE(limit.truncation, 1e-7) << kind << ", seed " << seed;
    EXPECT_TRUE(limit.trust.sound()) << kind << ", seed " << seed;
  }
}

}  // namespace
}  // namespace zwidth
