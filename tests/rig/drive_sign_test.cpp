// What a drive does to the sign, to its answers and to the delay.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>

#include "rig/drive_kinds.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/rig_actions.hpp"
#include "rig/rig_devices.hpp"
#include "rig/rig_host.hpp"
#include "rig/serial_device.hpp"
#include "rig/simulated_driver.hpp"

namespace zwidth::rig {
namespace {

using test::belt_device;
using test::DriveKind;
using test::PtyEmulator;
using Fault = PtyEmulator::Fault;

class SignOfDrive : public testing::TestWithParam<DriveKind> {
 protected:
  SignOfDrive() : emulator(GetParam().firmware(), device) {
    emulator.set_fault(Fault::no_watchdog);
    driver = GetParam().driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
  }

  const Device device = belt_device();
  PtyEmulator emulator;
  std::unique_ptr<Driver> driver;
};

WallOptions file_wall(const Device& device) {
  WallOptions wall;
  wall.controller = wall_controller(device.parameters().wall);
  wall.duration = 0.5;
  return wall;
}

TEST_P(SignOfDrive, IsToldByACheck) {
  const RigCheck found = check(device, *driver, {}, 0.1);
  ASSERT_TRUE(found.session.nudge);
  EXPECT_EQ(found.session.nudge->reading, NudgeReading::with_force);
  EXPECT_GT(found.session.nudge->moved, 0.0);
  EXPECT_EQ(found.session.stop, StopReason::none);
  EXPECT_TRUE(found.trust.sound());
}

// It ran away to 104 mm.
TEST_P(SignOfDrive, NoWallRunsOnAWrongOne) {
  emulator.motor().has_wrong_sign = true;
  const RigWall wall = render_wall(device, *driver, {}, file_wall(device));
  EXPECT_EQ(wall.session.stop, StopReason::wrong_sign);
  ASSERT_TRUE(wall.session.nudge);
  EXPECT_EQ(wall.session.nudge->reading, NudgeReading::against_force);
  EXPECT_EQ(wall.session.nudge->mending_force_sign, -1.0);
  EXPECT_LT(emulator.motor().largest_force(), default_force(device)) << "the nudge alone";
  EXPECT_EQ(wall.recording.channels.front().samples.size(), 0U);
  const auto finding = finding_of(wall.session);
  ASSERT_TRUE(finding);
  EXPECT_EQ(finding->code, FindingCode::moves_against_force);
  EXPECT_TRUE(test::within(std::chrono::seconds(5), [&] { return emulator.motor().force() == 0.0; }));
}

TEST_P(SignOfDrive, NorALimitNorARelay) {
  emulator.motor().has_wrong_sign = true;
  const RigLimit limit = measure_limit(device, *driver, {}, default_limit(device), {});
  EXPECT_EQ(limit.session.stop, StopReason::wrong_sign);
  EXPECT_FALSE(limit.measured.stiffness);
}

TEST_P(SignOfDrive, ACheckRefusesAWrongOne) {
  emulator.motor().has_wrong_sign = true;
  const RigCheck found = check(device, *driver, {}, 0.1);
  EXPECT_EQ(found.session.stop, StopReason::wrong_sign);
  EXPECT_TRUE(found.trust.refused());
}

// It pushed with a third of the force limit, whatever force was asked for.
TEST_P(SignOfDrive, IsToldByNoMoreThanTheActionsForce) {
  emulator.motor().has_wrong_sign = true;
  LimitOptions limit = default_limit(device);
  limit.impulse = 0.02 * default_force(device);
  EXPECT_TRUE(measure_limit(device, *driver, {}, limit, {}).session.nudge);
  EXPECT_LE(emulator.motor().largest_force(), 1.001 * limit.impulse);
  EXPECT_GT(emulator.motor().largest_force(), 0.0);
}

INSTANTIATE_TEST_SUITE_P(Drive, SignOfDrive, testing::ValuesIn(test::drive_kinds),
                         [](const auto& kind) { return std::string(kind.param.name); });
INSTANTIATE_TEST_SUITE_P(Can, SignOfDrive, testing::ValuesIn(test::can_drive_kinds), test::name_of_bus_drive);

// The only drive that needs no [driver]; it named no key then.
TEST(SignOfMicrocontroller, IsMendedByAKeyThoughTheFileHasNoDriver) {
  const Device device = belt_device();
  PtyEmulator emulator(std::make_unique<test::MicrocontrollerFirmware>(), device);
  emulator.set_fault(Fault::no_watchdog);
  emulator.motor().has_wrong_sign = true;
  MicrocontrollerDriver driver({emulator.path(), MotorDrive{}, device.loop().sampling_period, true});
  DeviceParameters parameters = device.parameters();
  parameters.driver.reset();
  const RigCheck found = check(Device(parameters), driver, {}, 0.1);
  ASSERT_TRUE(found.session.nudge);
  EXPECT_EQ(found.session.nudge->mending_force_sign, -1.0);
}

// No wall pushes with it; that it is wrong is seen.
TEST(SignOfIdentification, OfAWrongOneNothingIsSound) {
  const Device device = belt_device();
  PtyEmulator emulator(std::make_unique<test::SimplefocFirmware>(), device);
  emulator.motor().has_wrong_sign = true;
  SimplefocDriver driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
  const RigIdentification found = identify_on_rig(device, driver, {}, default_measurement(device), {});
  ASSERT_TRUE(found.identification);
  EXPECT_FALSE(found.trust.sound());
}

// With other inertia, other damping and an encoder than the file says, the sign is that of the device.
TEST(Nudge, TellsTheSignOfDevicesThatTheFileDoesNotKnow) {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    for (const double factor : {0.2, 1.0, 5.0}) {
      for (const double sign : {1.0, -1.0}) {
        SCOPED_TRACE(testing::Message() << seed << ' ' << factor << ' ' << sign);
        const Device device = test::bench_device(seed);
        DeviceParameters parameters = device.parameters();
        for (Body& body : parameters.bodies) body.damping *= factor;
        parameters.bodies.front().coulomb = 0.02 * default_force(device);
        const std::vector<double> force = nudge_force(device, 0.25 * default_force(device));
        parameters.sensor.resolution = 1e-5;
        SimulatedDriver driver{Device(parameters), 0.0, false};
        std::vector<double> position;
        for (const double each : force) {
          position.push_back(driver.measure().value());
          driver.command(sign * each);
        }
        const Nudge nudge = read_nudge(device, force, position);
        if (nudge.reading == NudgeReading::not_told) continue;
        EXPECT_EQ(nudge.reading, sign > 0.0 ? NudgeReading::with_force : NudgeReading::against_force);
      }
    }
  }
}

TEST(Nudge, IsNotReadFromNoMotionNorFromDrift) {
  const Device device = test::bench_device(1);
  const std::vector<double> force = nudge_force(device, 1.0);
  EXPECT_EQ(read_nudge(device, force, std::vector<double>(force.size(), 0.1)).reading, NudgeReading::not_told);
  std::vector<double> falling;
  for (std::size_t k = 0; k < force.size(); ++k) falling.push_back(1e-3 * static_cast<double>(k * k));
  EXPECT_EQ(read_nudge(device, force, falling).reading, NudgeReading::not_told);
  EXPECT_EQ(read_nudge(device, force, {}).reading, NudgeReading::not_told);
}

class AnswersOfDrive : public testing::TestWithParam<DriveKind> {};

// The first lost answer ended the session: each later one was taken for it.
TEST_P(AnswersOfDrive, OneThatIsLostDoesNotLoseTheNext) {
  const Device device = belt_device(0.05);
  PtyEmulator emulator(GetParam().firmware(), device);
  emulator.set_fault(Fault::no_watchdog);
  const auto driver = GetParam().driver({emulator.path(), *device.parameters().driver, 0.05, false});
  driver->allow_missed(3);
  driver->arm();
  emulator.set_fault(Fault::lost_answers);
  int answered = 0;
  int in_a_row = 0;
  int longest = 0;
  auto due = std::chrono::steady_clock::now();
  for (int k = 0; k < 40; ++k) {
    std::this_thread::sleep_until(due += std::chrono::milliseconds(50));
    if (driver->measure()) {
      ++answered;
      in_a_row = 0;
    } else {
      longest = std::max(longest, ++in_a_row);
    }
    driver->command(0.0);
  }
  EXPECT_GT(answered, 12) << "of a moteus an OK counts, too";
  EXPECT_LT(answered, 40);
  EXPECT_LT(longest, 5) << "two, and two more where the machine pauses";
}

INSTANTIATE_TEST_SUITE_P(Drive, AnswersOfDrive, testing::ValuesIn(test::drive_kinds),
                         [](const auto& kind) { return std::string(kind.param.name); });
INSTANTIATE_TEST_SUITE_P(Can, AnswersOfDrive, testing::ValuesIn(test::can_drive_kinds), test::name_of_bus_drive);

// The force's bytes leave after the system has taken them: at 9600 Bd some 14 ms, a third of the delay.
TEST(DelayOfDrive, IsThatOfTheWire) {
  DeviceParameters parameters = belt_device(0.1).parameters();
  parameters.driver->baud = 9600;
  const Device device(parameters);
  PtyEmulator emulator(std::make_unique<test::SimplefocFirmware>(), device, {.baud = 9600, .is_paced = true});
  SimplefocDriver driver({emulator.path(), *parameters.driver, 0.1, false});
  RigOptions options;
  options.nudge = false;
  (void)emulator.motor().mean_delay();
  const RigCheck found = check(device, driver, options, 1.0);
  ASSERT_EQ(found.session.stop, StopReason::none) << explanation(found.session);
  const double question = 10.0 * 5.0 / 9600.0;  // from asking to the drive's own reading
  const double truth = emulator.motor().mean_delay();
  EXPECT_GE(found.session.timing.delay.p50, truth);
  EXPECT_LT(found.session.timing.delay.p50, truth + question + 0.015);
}

TEST(LimitOfDrive, IsReadWhenItOpens) {
  const Device device = belt_device();
  const double travel = std::abs(device.parameters().driver->torque_per_force());
  PtyEmulator odrive(std::make_unique<test::OdriveFirmware>(), device);
  const OdriveDriver first({odrive.path(), *device.parameters().driver, 0.01, true});
  EXPECT_NEAR(first.facts().settings.force_limit.value(), 10.0 * 0.04 / travel, 1e-6);
  PtyEmulator simplefoc(std::make_unique<test::SimplefocFirmware>(), device);
  const SimplefocDriver second({simplefoc.path(), *device.parameters().driver, 0.01, true});
  EXPECT_NEAR(second.facts().settings.force_limit.value(), 2.0 * 0.05 / travel, 1e-6);
}

}  // namespace
}  // namespace zwidth::rig
