// The quick count that guards every answer is never wrong: whatever it calls sure, the count in a hundred digits says too.
#include "stability/second_route/routh_count.hpp"

#include <gtest/gtest.h>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "stability/second_route/pole_count.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
using namespace internal;
namespace {

DiscreteStateSpace sampled(const Device& device) {
  return sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
}

struct Count {
  int asked = 0;
  int sure = 0;
};

// Near the critical stiffness and far from it.
void compare_with_digits(const Device& device, Count& count) {
  const DiscreteStateSpace plant = sampled(device);
  if (!RouthCount::suits(plant)) return;
  const CriticalStiffness critical = critical_stiffness(filtered_plant(device), virtual_damper(device));
  const double about = critical.status == StiffnessStatus::finite ? critical.stiffness : 1.0;
  const Wall& wall = device.parameters().wall;
  const RouthCount routh(plant, wall);
  for (const double share : {1e-3, 0.5, 1.0 - 1e-6, 1.0 - 1e-9, 1.0 + 1e-9, 1.0 + 1e-6, 2.0, 30.0}) {
    const double stiffness = share * about;
    const bool stable = routh.surely(true, stiffness, wall.damping);
    const bool unstable = routh.surely(false, stiffness, wall.damping);
    ++count.asked;
    if (!stable && !unstable) continue;
    ++count.sure;
    EXPECT_FALSE(stable && unstable) << share;
    if (const auto outside = unstable_poles_in_digits(device, stiffness)) {
      EXPECT_EQ(*outside == 0, stable) << share;
    }
  }
}

TEST(RouthCount, WhatItCallsSureIsWhatDigitsSay) {
  Count count;
  for (unsigned seed = 1; seed <= 84; ++seed) {
    const auto kind = test::device_kinds[seed % test::device_kinds.size()];
    SCOPED_TRACE(testing::Message() << "seed " << seed << " " << kind);
    test::RandomDevices random(seed);
    compare_with_digits(Device(random.device(kind)), count);
  }
  EXPECT_GT(count.sure, 9 * count.asked / 10) << count.asked;  // else it is no use
}

// Poles that crowd: eigenvalues of the same matrices scatter there.
TEST(RouthCount, OfCrowdedPolesTooWhatItCallsSureIsWhatDigitsSay) {
  Count count;
  for (unsigned seed = 1; seed <= 160; ++seed) {
    const auto kind = test::crowded_kinds[seed % test::crowded_kinds.size()];
    SCOPED_TRACE(testing::Message() << "seed " << seed << " " << kind);
    test::RandomDevices random(seed);
    try {
      compare_with_digits(Device(random.crowded_device(kind)), count);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::did_not_converge);
    }
  }
  EXPECT_GT(count.asked, 0);
}

TEST(RouthCount, AgreesWithEigenvaluesOverStiffnessAndDamping) {
  for (const double delay : {0.0, 0.25e-3, 8e-3, 8.25e-3, 15e-3}) {
    const Device device(test::with_delay(test::lhifam_parameters(), delay));
    const DiscreteStateSpace plant = sampled(device);
    for (const double velocity_filter_hz : {0.0, 80.0}) {
      Wall wall{1.0, 1.0, velocity_filter_hz};
      wall.filters.push_back(
          {.kind = WallFilter::Kind::notch, .frequency_hz = 60.0, .damping_ratio = 0.5, .depth = 0.1});
      const RouthCount routh(plant, wall);
      for (const double stiffness : {3.0, 100.0, 3e3, 3e4}) {
        for (const double damping : {0.0, 0.3, 10.0, 300.0}) {
          Wall at = wall;
          at.stiffness = stiffness;
          at.damping = damping;
          const bool stable = stability_excess(plant, at) < 0.0;
          EXPECT_TRUE(routh.surely(stable, stiffness, damping)) << delay << " " << stiffness << " " << damping;
          EXPECT_FALSE(routh.surely(!stable, stiffness, damping)) << delay << " " << stiffness << " " << damping;
        }
      }
    }
  }
}

// A pole that nothing damps and nothing moves is not surely inside, nor outside.
TEST(RouthCount, APoleOnTheCircleIsNotSure) {
  DeviceParameters undamped;
  undamped.name = "undamped";
  undamped.bodies = {{"motor", 1.0, 0.0, 0.0, 0.0}, {"handle", 0.5, 0.0, 0.0, 0.0}};
  undamped.links = {{0, 1, 4e3, 0.0}};
  undamped.loop.sampling_period = 1e-3;
  const RouthCount routh(sampled(Device(undamped)), {});
  EXPECT_FALSE(routh.surely(true, 0.0, 0.0));
  EXPECT_FALSE(routh.surely(false, 0.0, 0.0));
}

}  // namespace
}  // namespace zwidth
