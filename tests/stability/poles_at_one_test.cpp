// Poles at z = 1 that the wall does not see, and poles next to it: neither decides whether the loop is stable.

#include <gtest/gtest.h>

#include "lhifam.hpp"
#include "stability/pole_count.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

// The limit is finite, sure, and within 1e-6 where a hundred digits find it.
void expect_sure_limit(const DeviceParameters& parameters) {
  const Device device(parameters);
  const CriticalStiffness result = critical_stiffness(device);
  EXPECT_TRUE(result.trust.sound());
  ASSERT_EQ(result.status, StiffnessStatus::finite);
  for (const double below : {1e-6, 0.5, 1.0 - 1e-6}) {
    EXPECT_EQ(internal::unstable_poles_in_digits(device, below * result.stiffness), 0) << below;
  }
  EXPECT_EQ(internal::unstable_poles_in_digits(device, (1.0 + 1e-6) * result.stiffness), 2);
}

int integrators(const DeviceParameters& parameters) {
  int sum = 0;
  for (const SampledTerm& term : sampled_plant(Device(parameters)).terms) sum += term.integrators;
  return sum;
}

DeviceParameters two_bodies(Body motor, Body handle, Link link) {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies = {motor, handle};
  device.links = {link};
  device.loop.sensed = device.loop.actuated = 0;
  device.loop.held = 0;
  return device;
}

// The motor on a spring to ground, the handle held to it by a damper alone: the handle rests anywhere.
TEST(PolesAtOne, BodyWithoutAPlaceOfItsOwn) {
  DeviceParameters device = two_bodies({"motor", 0.112247, 0.124101, 79.7557, 0.0},
                                       {"handle", 0.0482144, 7.81128, 0.0, 0.0}, {0, 1, 0.0, 0.179847});
  for (const double mass : {0.0, 1.3725, 8.62249, 67.1453}) {
    device.user.mass = mass;
    EXPECT_EQ(integrators(device), 0);
    expect_sure_limit(device);
  }
}

// Both free, joined by a damper alone and each damped to ground: two poles at s = 0, one of them seen.
TEST(PolesAtOne, OneOfTwoIsSeen) {
  DeviceParameters device =
      two_bodies({"motor", 0.0183, 0.0576, 0.0, 0.0}, {"handle", 2.356, 0.112, 0.0, 0.0}, {0, 1, 0.0, 7.97});
  EXPECT_EQ(integrators(device), 1);
  expect_sure_limit(device);
  device.bodies[0].damping = device.bodies[1].damping = 0.0;  // now nothing holds them: m s² is seen, one pole is not
  EXPECT_EQ(integrators(device), 2);
}

// A held body joined to neither ground nor the sensed one by a spring, dampers through a grounded body alone.
TEST(PolesAtOne, NoneIsSeenThroughAGroundedBody) {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies = {{"motor", 0.3, 0.0, 0.0, 0.0}, {"frame", 1.0, 0.5, 500.0, 0.0}, {"handle", 0.2, 0.0, 0.0, 0.0}};
  device.links = {{0, 1, 0.0, 2.0}, {1, 2, 0.0, 3.0}};
  device.loop.actuated = device.loop.sensed = 0;
  device.loop.held = 2;
  EXPECT_EQ(integrators(device), 1);
  device.loop.sensed = 2;
  EXPECT_EQ(integrators(device), 0);
}

// A user of 70 000 t: the pole next to z = 1 is slower than 1e-9 rad per sample, and the damper's integrator with it.
TEST(PolesAtOne, VeryHeavyUserOfADampedWall) {
  DeviceParameters device = two_bodies({"motor", 0.0216215, 0.0393388, 0.0, 0.0},
                                       {"handle", 2.18153, 0.0123903, 0.0, 0.0}, {0, 1, 474.366, 0.501788});
  device.loop.delay = 0.0;
  device.loop.sampling_period = 1e-3;
  device.loop.held = 0;
  device.actuator.time_constant = 14.813;
  device.wall.damping = 38.0352;
  device.wall.velocity_filter_hz = 64.3886;
  for (const double mass : {817227.0, 6.98965e7}) {
    device.user.mass = mass;
    expect_sure_limit(device);
  }
}

}  // namespace
}  // namespace zwidth
