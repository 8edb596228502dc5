// A motor without losses behind a cable without losses: at the frequency at which it holds its joint still, nothing damps a motion
// of the tip, and the discs grow without bound.

#include <gtest/gtest.h>

#include <string>

#include "zwidth/mechanism.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

/// The motor of `a` and its cable of 600 N m/rad hold the joint at 1732 rad/s.
Device arm_with_lossless_motor(double period, double delay, double motor_damping) {
  MechanismFile file;
  file.text =
      "<mujoco><compiler angle='radian'/><worldbody>"
      "<body><joint name='a' axis='0 0 1' damping='0.005'/><inertial pos='0.1 0 0' mass='0.2' diaginertia='1e-4 1e-3 "
      "1e-3'/>"
      "<body pos='0.2 0 0'><joint name='b' axis='0 0 1' damping='0.005'/><inertial pos='0.1 0 0' mass='0.1' "
      "diaginertia='1e-4 5e-4 5e-4'/><site name='tip' pos='0.2 0 0'/></body></body></worldbody></mujoco>";
  file.tip = "tip";
  file.pose = {{"a", 0.3}, {"b", 1.0}};
  file.transmissions = {
      {.joint = "a", .ratio = 10.0, .inertia = 2e-6, .motor_damping = motor_damping, .stiffness = 600.0},
      {.joint = "b", .ratio = 10.0, .inertia = 2e-6, .motor_damping = 1e-6, .stiffness = 600.0, .damping = 0.05}};
  DeviceParameters parameters;
  parameters.mechanism = MechanismDirection{file, {1.0, 0.0, 0.0}};
  parameters.loop.sampling_period = period;
  parameters.loop.delay = delay;
  return device_of_mechanism(std::move(parameters));
}

/// Discs of 50 digits on a grid of frequencies of its own: 25.256, 20.17 and 14.38 N/m. A spring of 2.4444 N/m along (-0.0385, 0.9993)
/// and a mass of 1.0192 kg across it grow at 26 N/m and decay at 24.5.
TEST(LosslessMotor, BoundsTheWallBelowNyquist) {
  for (const auto& [delay, limit] : {std::pair{1.5e-3, 25.256}, {2e-3, 20.17}, {3e-3, 14.38}}) {
    SCOPED_TRACE(delay);
    const Device lossless = arm_with_lossless_motor(1e-3, delay, 0.0);
    EXPECT_GT(critical_stiffness(lossless).stiffness, 2.0 * limit);
    const AbsoluteStabilityLimit found = absolute_stability_limit(lossless);
    EXPECT_NEAR(found.stiffness, limit, 1e-3 * limit);
    for (const double damping : {1e-16, 1e-14, 1e-12, 1e-8}) {
      EXPECT_NEAR(absolute_stability_limit(arm_with_lossless_motor(1e-3, delay, damping)).stiffness, found.stiffness,
                  2e-4 * limit)
          << damping;
    }
  }
}

/// Above Nyquist its alias is a half plane, which holds every wall where the delay turns it so.
TEST(LosslessMotor, BoundsTheWallAboveNyquist) {
  const AbsoluteStabilityLimit turned = absolute_stability_limit(arm_with_lossless_motor(3e-3, 3e-3, 0.0));
  EXPECT_EQ(turned.stiffness, 0.0);
  const double hardly = absolute_stability_limit(arm_with_lossless_motor(3e-3, 3e-3, 1e-8)).stiffness;
  EXPECT_NEAR(hardly, 0.13633, 1e-3);
  const AbsoluteStabilityLimit other = absolute_stability_limit(arm_with_lossless_motor(2.13e-3, 2.13e-3, 0.0));
  EXPECT_NEAR(other.stiffness, 15.760, 1e-2);
}

}  // namespace
}  // namespace zwidth
