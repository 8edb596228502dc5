#include "design/region/real_poles.hpp"

#include <gtest/gtest.h>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
using namespace internal;
namespace {

bool swings(const Device& device, double stiffness, double damping) {
  Wall wall = device.parameters().wall;
  wall.stiffness = stiffness;
  wall.damping = damping;
  const auto poles = closed_loop_poles_minus_one(
      sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), wall);
  for (const std::complex<double>& delta : poles) {
    if (delta.real() > -0.5 && delta.imag() != 0.0) return true;
  }
  return false;
}

// A rigid device with a damper: closed-loop poles are real up to where they meet, and a pair from there on.
TEST(RealPoles, MeetWhereTheContactOfARigidDeviceBeginsToSwing) {
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    test::RandomDevices random(seed);
    DeviceParameters parameters = random.device("rigid");
    if (seed % 3 == 0) parameters.loop.delay = 2.4e-3;
    if (seed % 4 == 0) parameters.wall.velocity_filter_hz = 100.0;
    const Device device(parameters);
    const double damping = random.log_uniform(0.01, 0.1) * parameters.bodies[0].mass /
                           (parameters.loop.sampling_period + parameters.loop.delay);
    const auto meeting = RealPoles(filtered_plant(device), parameters.wall.velocity_filter_hz).meeting(damping);
    ASSERT_TRUE(meeting);
    EXPECT_FALSE(swings(device, *meeting * (1.0 - 2e-3), damping));
    EXPECT_TRUE(swings(device, *meeting * (1.0 + 2e-3), damping));
  }
}

TEST(RealPoles, OfASpringWithoutAnyDampingDoNotMeet) {
  DeviceParameters parameters = test::rigid_parameters();
  for (Body& body : parameters.bodies) body.damping = 0.0;
  EXPECT_FALSE(RealPoles(filtered_plant(Device(parameters)), 0.0).meeting(0.0));
}

}  // namespace
}  // namespace zwidth
