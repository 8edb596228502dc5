#include <gtest/gtest.h>

#include <complex>

#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {
namespace {

TEST(LockedDevice, ALinkToALockedBodyIsASpringAndDamperToGround) {
  const Device locked = locked_device(Device(test::lhifam_parameters()), {1});
  ASSERT_EQ(locked.bodies().size(), 1U);
  EXPECT_EQ(locked.bodies()[0].name, "motor");
  EXPECT_EQ(locked.bodies()[0].mass, 0.3);
  EXPECT_EQ(locked.bodies()[0].damping, 0.1 + 15.0);
  EXPECT_EQ(locked.bodies()[0].stiffness, 79.5e3);
  EXPECT_TRUE(locked.links().empty());
}

// An independent route to the same thing: a body so heavy that it does not move.
TEST(LockedDevice, IsTheLimitOfAHeavyBody) {
  DeviceParameters three = test::lhifam_parameters();
  three.bodies.push_back({"tool", 0.4, 0.2, 100.0, 0.0});
  three.links.push_back({1, 2, 2e4, 4.0});
  three.links.push_back({0, 2, 1e4, 3.0});
  three.loop.held = 2;
  const SampledPlant locked = sampled_plant(locked_device(Device(three), {1}));
  three.bodies[1].mass = 1e12;
  const SampledPlant heavy = sampled_plant(Device(three));
  for (double frequency = 10.0; frequency < 3000.0; frequency *= 1.3) {
    const std::complex<double> expected = response(heavy, frequency);
    EXPECT_LT(std::abs(response(locked, frequency) - expected), 1e-8 * std::abs(expected)) << frequency;
  }
}

TEST(LockedDevice, WhatLiesBehindALockedBodyIsLeftOut) {
  DeviceParameters chain = test::lhifam_parameters();
  chain.bodies.push_back({"tool", 0.4, 0.2, 0.0, 0.0});
  chain.links.push_back({1, 2, 2e4, 4.0});
  chain.loop.held = 2;
  chain.user = {1.0, 2.0, 3.0};
  const Device locked = locked_device(Device(chain), {1});
  ASSERT_EQ(locked.bodies().size(), 1U);
  EXPECT_EQ(locked.loop().held, 0U);
  EXPECT_EQ(locked.parameters().user.mass, 0.0);  // the operator's body stands still
}

TEST(LockedDevice, NothingLockedChangesNothing) {
  const Device device(test::lhifam_parameters());
  EXPECT_EQ(locked_device(device, {}).bodies().size(), 2U);
}

TEST(LockedDevice, RefusesWhatCannotBeLocked) {
  const Device device(test::lhifam_parameters());
  EXPECT_THROW((void)locked_device(device, {0}), Error);
  EXPECT_THROW((void)locked_device(device, {7}), Error);
  EXPECT_THROW((void)locked_device(Device(test::handle_sensed(test::lhifam_parameters())), {1}), Error);
  EXPECT_THROW((void)locked_device(Device(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1e-3)), {}), Error);
  DeviceParameters chain = test::lhifam_parameters();
  chain.bodies.push_back({"tool", 0.4, 0.2, 0.0, 0.0});
  chain.links.push_back({1, 2, 2e4, 4.0});
  chain.loop.sensed = 2;
  EXPECT_THROW((void)locked_device(Device(chain), {1}), Error);  // parts the sensed body from the actuated one
}

}  // namespace
}  // namespace zwidth
