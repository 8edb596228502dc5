// Dry friction and limits of force with a serial line between the rig and the motor.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include "rig/drive_kinds.hpp"
#include "rig/measured_as_predicted.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/rig_actions.hpp"
#include "rig/rig_host.hpp"
#include "rig/serial_device.hpp"
#include "rig/simulated_driver.hpp"

namespace zwidth::rig {
namespace {

using test::belt_device;
using test::DriveKind;
using test::PtyEmulator;

constexpr double coulomb = 0.01;  // N, a hundredth of the impulses: more would hold the swing down for good

/// N, of a force in whole milliamperes.
double rounding(const Device& device) {
  const MotorDrive& drive = *device.parameters().driver;
  return 0.5e-3 * *drive.torque_constant / std::abs(drive.torque_per_force()) * (1.0 + 1e-6);
}

class LimitsOnDrive : public testing::TestWithParam<DriveKind> {
 protected:
  explicit LimitsOnDrive(double friction = 0.0)
      : device([&] {
          DeviceParameters parameters = belt_device().parameters();
          parameters.bodies.front().coulomb = friction;
          return Device(parameters);
        }()),
        emulator(GetParam().firmware(), device) {
    emulator.set_fault(PtyEmulator::Fault::no_watchdog);
    driver = GetParam().driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
  }
  /// And for good: the drive has been told.
  void expect_no_force() const {
    EXPECT_TRUE(test::within(std::chrono::seconds(5), [&] { return emulator.motor().force() == 0.0; }));
  }

  const Device device;
  PtyEmulator emulator;
  std::unique_ptr<Driver> driver;
};

class FrictionOnDrive : public LimitsOnDrive {
 protected:
  FrictionOnDrive() : LimitsOnDrive(coulomb) {}
};

// What friction does to the limit it does behind the line as well, and the answer says so.
TEST_P(FrictionOnDrive, TheLimitIsThatOfTheSimulationAndDoubtful) {
  const LimitOptions with_impulse = default_limit(device);
  const RigLimit limit = measure_limit(device, *driver, {}, with_impulse, {});
  SimulatedDriver simulated{device, 0.0, false};
  const RigLimit expected = measure_limit(device, simulated, {}, with_impulse, {});
  ASSERT_TRUE(limit.measured.stiffness) << explanation(limit.session.stop)
                                        << testing::PrintToString(limit.measured.trust.reasons);
  ASSERT_TRUE(expected.measured.stiffness);
  EXPECT_NEAR(*limit.measured.stiffness / *expected.measured.stiffness, 1.0, 0.02);
  EXPECT_NEAR(limit.measured.frequency / expected.measured.frequency, 1.0, 0.02);
  EXPECT_GT(*limit.measured.stiffness, 1.01 * limit.predicted.stiffness) << "friction damps";
  EXPECT_FALSE(limit.measured.trust.sound());
  const auto is_friction = [](const Finding& each) { return each.code == FindingCode::friction_holds_swing; };
  EXPECT_TRUE(std::ranges::any_of(limit.measured.trust.findings, is_friction));
  expect_no_force();
}

TEST_P(FrictionOnDrive, TheRelayIsThatOfTheSimulation) { expect_relay(device, *driver); }

TEST_P(FrictionOnDrive, AMeasurementMovesTheDeviceAndIsDoubtful) {
  const RigMeasurement measured = measure(device, *driver, {}, default_measurement(device), {});
  ASSERT_TRUE(measured.response);
  EXPECT_GT(emulator.motor().largest_force(), coulomb) << "else it sticks";
  EXPECT_FALSE(measured.trust.sound());
  const auto is_friction = [](const Finding& each) { return each.code == FindingCode::friction_in_response; };
  EXPECT_TRUE(std::ranges::any_of(measured.trust.findings, is_friction));
  expect_no_force();
}

// A limit found with a force that was cut off is that of another wall.
TEST_P(LimitsOnDrive, TheForceIsCutOffAndTheLimitRefused) {
  RigOptions options;
  options.nudge = false;
  options.limits.force = 1.0;
  options.limits.saturation_duration = 100.0;
  LimitOptions limit = default_limit(device);
  limit.impulse = 8.0;
  const RigLimit measured = measure_limit(device, *driver, options, limit, {});
  EXPECT_NEAR(emulator.motor().largest_force(), 1.0, rounding(device)) << "what came out of the line, at the most";
  EXPECT_TRUE(measured.measured.trust.refused());
  EXPECT_FALSE(measured.measured.stiffness);
  expect_no_force();
}

TEST_P(LimitsOnDrive, ForceBeyondTheLimitForTooLongIsZeroForce) {
  RigOptions options;
  options.nudge = false;
  options.limits.force = 1.0;
  options.limits.saturation_duration = 0.05;
  options.limits.ramp = 0.0;
  WallOptions wall;
  wall.controller = wall_controller(device.parameters().wall);
  wall.impulse = 10.0;
  const RigWall rendered = render_wall(device, *driver, options, wall);
  EXPECT_EQ(rendered.session.stop, StopReason::saturation);
  EXPECT_NEAR(emulator.motor().largest_force(), 1.0, rounding(device));
  EXPECT_LE(emulator.motor().nonzero_forces(), 6) << "0.05 s are five cycles, and one that was under way";
  expect_no_force();
}

TEST_P(LimitsOnDrive, APositionBeyondItsLimitIsZeroForce) {
  RigOptions options;
  options.nudge = false;
  options.limits.position = 2e-3;
  WallOptions wall;
  wall.controller = wall_controller(device.parameters().wall);
  wall.impulse = 8.0;
  const RigWall rendered = render_wall(device, *driver, options, wall);
  EXPECT_EQ(rendered.session.stop, StopReason::position_limit);
  EXPECT_LT(rendered.peak_position, 2 * 2e-3);
  expect_no_force();
}

TEST_P(LimitsOnDrive, AVelocityBeyondItsLimitIsZeroForce) {
  RigOptions options;
  options.nudge = false;
  options.limits.velocity = 0.02;
  WallOptions wall;
  wall.controller = wall_controller(device.parameters().wall);
  wall.impulse = 8.0;
  EXPECT_EQ(render_wall(device, *driver, options, wall).session.stop, StopReason::velocity_limit);
  expect_no_force();
}

// All of them were told to check cable, port and baud rate.
TEST_P(LimitsOnDrive, WhatTheDriveSaysOfItsFaultIsTold) {
  if (!GetParam().has_watchdog) return;  // nor does it tell of faults
  driver->arm();
  ASSERT_TRUE(driver->measure());
  EXPECT_FALSE(driver->trouble());
  emulator.set_fault(PtyEmulator::Fault::failed_drive);
  EXPECT_TRUE(test::within(std::chrono::seconds(20), [&] {
    driver->command(0.1);
    return !driver->measure();
  }));
  RigSession session;
  session.stop = StopReason::lost_link;
  session.trouble = driver->trouble();
  ASSERT_TRUE(session.trouble);
  using enum DriveProblemCode;
  EXPECT_THAT(session.trouble->code, testing::AnyOf(odrive_fault, moteus_fault, vesc_fault, microcontroller_fault));
  EXPECT_EQ(finding_of(session).value().code, FindingCode::drive_in_trouble);
  session.trouble.reset();
  EXPECT_EQ(finding_of(session).value().code, FindingCode::lost_link);
}

const auto name_of = [](const auto& kind) { return std::string(kind.param.name); };
INSTANTIATE_TEST_SUITE_P(Drive, LimitsOnDrive, testing::ValuesIn(test::drive_kinds), name_of);
INSTANTIATE_TEST_SUITE_P(Drive, FrictionOnDrive, testing::ValuesIn(test::drive_kinds), name_of);
INSTANTIATE_TEST_SUITE_P(Can, LimitsOnDrive, testing::ValuesIn(test::can_drive_kinds), test::name_of_bus_drive);
INSTANTIATE_TEST_SUITE_P(Can, FrictionOnDrive, testing::ValuesIn(test::can_drive_kinds), test::name_of_bus_drive);

}  // namespace
}  // namespace zwidth::rig
