// ODrive's firmware from 0.5.1 to 0.6: what differs from one to the next, on emulated drives.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "rig/odrive_driver.hpp"
#include "rig/odrive_firmware.hpp"
#include "rig/odrive_protocol.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/rig_host.hpp"
#include "rig/serial_device.hpp"

namespace zwidth::rig {
namespace {

using test::OdriveFirmware;
using test::PtyEmulator;
using Version = OdriveFirmware::Version;

std::string name_of(Version version) {
  constexpr const char* names[] = {"v0_5_1", "v0_5_2", "v0_5_6", "v0_6"};
  return names[static_cast<int>(version)];
}

class OdriveVersions : public testing::TestWithParam<Version> {
 protected:
  const Device device = test::belt_device();
};

TEST_P(OdriveVersions, AreDrivenAndLeftAsTheyWere) {
  auto firmware = std::make_unique<OdriveFirmware>(GetParam());
  const OdriveFirmware& drive = *firmware;
  PtyEmulator emulator(std::move(firmware), device);
  {
    const MotorDrive& motor = *device.parameters().driver;
    OdriveDriver driver({emulator.path(), motor, device.loop().sampling_period, true});
    EXPECT_NEAR(driver.facts().settings.force_limit.value(), 10.0 * 0.04 / std::abs(motor.torque_per_force()), 1e-6);
    EXPECT_EQ(driver.proves_watchdog(), true);
    driver.arm();
    EXPECT_TRUE(drive.has_watchdog());
    driver.command(2.0);
    for (int i = 0; i < 20; ++i) {
      ASSERT_TRUE(driver.measure()) << i;
      driver.command(2.0);
    }
    EXPECT_NEAR(emulator.motor().force(), 2.0, 1e-4);
    driver.disarm();
  }
  EXPECT_TRUE(test::within(std::chrono::seconds(5), [&] { return !drive.has_watchdog(); }));
  EXPECT_EQ(emulator.motor().force(), 0.0);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_FALSE(drive.has_error());
}

TEST_P(OdriveVersions, SayThatTheyFailed) {
  PtyEmulator emulator(std::make_unique<OdriveFirmware>(GetParam()), device);
  OdriveDriver driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
  driver.arm();
  emulator.set_fault(PtyEmulator::Fault::failed_drive);
  int answered = 0;
  for (; answered < 1000 && driver.measure(); ++answered) driver.command(0.0);
  EXPECT_LT(answered, 1000);
  ASSERT_TRUE(driver.trouble());
  EXPECT_EQ(driver.trouble()->code, DriveProblemCode::odrive_fault);
}

// (vel_limit - 0) vel_gain = 0.333 N m, less than 10 A allow.
TEST(OdriveLimits, TheVelocityLimitOfTorqueControlBoundsTheTorque) {
  const Device device = test::belt_device();
  auto firmware = std::make_unique<OdriveFirmware>();
  firmware->set("controller.config.enable_torque_mode_vel_limit", 1.0);
  PtyEmulator emulator(std::move(firmware), device);
  const MotorDrive& motor = *device.parameters().driver;
  const OdriveDriver driver({emulator.path(), motor, device.loop().sampling_period, true});
  EXPECT_NEAR(driver.facts().settings.force_limit.value() * std::abs(motor.torque_per_force()), 2.0 / 6.0, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(From, OdriveVersions,
                         testing::Values(Version::v0_5_1, Version::v0_5_2, Version::v0_5_6, Version::v0_6),
                         [](const auto& version) { return name_of(version.param); });

// 0.5.2 ends an answer by its checksum alone, however its bytes come.
TEST(OdriveProtocol, AnswersWithoutAnEndOfTheirLine) {
  const std::string two = "1.250000 -0.500000*140*48";
  EXPECT_EQ(odrive_unended_answer_size(two), 21U);
  EXPECT_EQ(odrive_unended_answer_size(std::string_view(two).substr(21)), 4U);
  for (std::size_t size = 0; size < 21; ++size) {
    EXPECT_EQ(odrive_unended_answer_size(std::string_view(two).substr(0, size)), 0U) << size;
  }
  EXPECT_EQ(odrive_unended_answer_size("unknown command\r\n1.2"), 17U);
  EXPECT_EQ(odrive_unended_answer_size("\r\n0*48\r\n"), 6U);
  EXPECT_EQ(*odrive_answer(std::string_view("\r\n0*48")), "0");
  const std::string_view broken = "1.350000 -0.500000*14\r\n";
  EXPECT_GT(odrive_unended_answer_size(broken), 19U);
  EXPECT_FALSE(odrive_answer(broken.substr(0, odrive_unended_answer_size(broken))));
}

}  // namespace
}  // namespace zwidth::rig
