#include "zwidth/stability/user_family.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

constexpr UserFamily arms{{0.0, 2.0}, {0.0, 30.0}, {0.0, 1000.0}};

double held_stiffness(DeviceParameters parameters, const User& user, VirtualDamper damper = {}) {
  parameters.user = user;
  return critical_stiffness(filtered_plant(Device(parameters)), damper).stiffness;
}

User drawn(const UserFamily& family, test::RandomDevices& random) {
  // Half of them near the least values, where K_CR changes fastest.
  const auto value = [&](const ValueRange& range) {
    const double share = random.uniform(0.0, 1.0);
    return range.least + (range.greatest - range.least) * (random.chance(0.5) ? share : std::pow(share, 5.0));
  };
  return {value(family.mass), value(family.damping), value(family.stiffness)};
}

TEST(UserFamily, WhatIsNotToldIsTheDevicesOwn) {
  const UserFamily family = user_family({.damping = ValueRange{1.0, 2.0}}, {0.5, 4.0, 100.0});
  EXPECT_EQ(family.mass.least, 0.5);
  EXPECT_EQ(family.mass.greatest, 0.5);
  EXPECT_EQ(family.damping.greatest, 2.0);
  EXPECT_EQ(family.stiffness.least, 100.0);
}

TEST(UserFamily, OneUserIsItsOwnWorst) {
  const UserFamily family{{0.5, 0.5}, {7.0, 7.0}, {140.0, 140.0}};
  const WorstOfFamily worst = worst_of_family(Device(test::lhifam_parameters()), family);
  EXPECT_EQ(worst.user.mass, 0.5);
  EXPECT_EQ(worst.user.damping, 7.0);
  EXPECT_EQ(worst.user.stiffness, 140.0);
  EXPECT_EQ(worst.critical_stiffness, held_stiffness(test::lhifam_parameters(), worst.user));
}

// A pure spring of 363 025 N/m at the handle has K_CR = 5776.115 (theory notes, section 5): nearly the worst of all.
TEST(UserFamily, FindsTheWorstSpring) {
  const Device device(test::lhifam_parameters());
  const WorstOfFamily worst = worst_of_family(device, {{0.0, 0.0}, {0.0, 0.0}, {0.0, 1e6}});
  const double limit = absolute_stability_limit(device).stiffness;
  EXPECT_GE(worst.critical_stiffness, limit);
  EXPECT_LE(worst.critical_stiffness, limit * (1.0 + 5e-6));
  EXPECT_NEAR(worst.user.stiffness, 363025.0, 2000.0);
}

// Damping alone steadies this device: the worst of the family lies on its face b = 0.
TEST(UserFamily, TheWorstOfTheReferenceDeviceIsUndamped) {
  const WorstOfFamily worst = worst_of_family(Device(test::lhifam_parameters()), arms);
  EXPECT_EQ(worst.user.damping, 0.0);
  EXPECT_EQ(worst.critical_stiffness, held_stiffness(test::lhifam_parameters(), worst.user));
}

// No user drawn from the family is worse, the limit over all passive users is not passed, and eigenvalues see the loop
// unstable just above.
TEST(UserFamily, NoDrawnUserIsWorse) {
  for (std::size_t seed = 0; seed < 48; ++seed) {
    test::RandomDevices random(seed + 4000);
    const auto kind = test::device_kinds[seed % test::reference_kinds];
    DeviceParameters parameters = random.device(kind);
    if (kind == "rotary") continue;  // of other magnitudes
    const VirtualDamper damper{parameters.wall.damping, parameters.wall.velocity_filter_hz};
    const Device device(parameters);
    const WorstOfFamily worst = worst_of_family(device, arms, damper);
    EXPECT_GE(worst.critical_stiffness, absolute_stability_limit(device, damper).stiffness * (1.0 - 3e-6))
        << kind << ", " << seed;
    for (int i = 0; i < 100; ++i) {
      const User user = drawn(arms, random);
      EXPECT_GE(held_stiffness(parameters, user, damper), worst.critical_stiffness * (1.0 - 1e-6))
          << kind << ", seed " << seed << ": " << user.mass << ", " << user.damping << ", " << user.stiffness;
    }
    if (worst.critical_stiffness == 0.0 || !std::isfinite(worst.critical_stiffness)) continue;
    parameters.user = worst.user;
    Wall wall = parameters.wall;
    wall.stiffness = worst.critical_stiffness * 1.0001;
    const DiscreteStateSpace plant =
        sample(state_space(Device(parameters)), {parameters.loop.sampling_period, parameters.loop.delay});
    EXPECT_GT(stability_excess(plant, wall), 0.0) << kind << ", seed " << seed;
  }
}

TEST(UserFamily, ProgressRisesToOne) {
  std::vector<double> fractions;
  (void)worst_of_family(Device(test::lhifam_parameters()), arms, {},
                        [&](double fraction) { fractions.push_back(fraction); });
  ASSERT_FALSE(fractions.empty());
  for (std::size_t i = 1; i < fractions.size(); ++i) EXPECT_GE(fractions[i], fractions[i - 1]);
  EXPECT_EQ(fractions.back(), 1.0);
}

TEST(UserFamily, RefusesImpossibleRanges) {
  const Device device(test::lhifam_parameters());
  for (const ValueRange& range : {ValueRange{-1.0, 1.0}, ValueRange{2.0, 1.0}, ValueRange{0.0, std::nan("")},
                                  ValueRange{0.0, std::numeric_limits<double>::infinity()}}) {
    EXPECT_THROW((void)worst_of_family(device, {range, {}, {}}), Error);
    EXPECT_THROW((void)worst_of_family(device, {{}, range, {}}), Error);
    EXPECT_THROW((void)worst_of_family(device, {{}, {}, range}), Error);
  }
  EXPECT_THROW((void)worst_of_family(Device(test::transfer_function_parameters({1}, {1, 1}, 1e-3)), arms), Error);
}

}  // namespace
}  // namespace zwidth
