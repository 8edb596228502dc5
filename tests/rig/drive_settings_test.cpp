// What drives tell of their own settings: firmware, filters, limits below which they give no force, and what those mean for a session.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <utility>

#include "rig/drive_failure.hpp"
#include "rig/drive_kinds.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/rig_host.hpp"
#include "zwidth/rig/wall_verdict.hpp"

namespace zwidth::rig {
namespace {

using enum DriveProblemCode;
using test::code_of;
using test::failure_of;
using test::MoteusFirmware;
using test::number_of;
using test::OdriveFirmware;
using test::PtyEmulator;
using test::SimplefocFirmware;
using test::VescCanNode;
using test::VescFirmware;

SerialLink lock_step_link(const PtyEmulator& emulator, const Device& device, bool is_can = false) {
  return {.port = emulator.path(),
          .drive = *device.parameters().driver,
          .sampling_period = device.loop().sampling_period,
          .lock_step = true,
          .is_can = is_can};
}

/// What its driver tells of a drive that is in order.
template <typename Kind>
DriveSettings settings_of(std::unique_ptr<test::Firmware> firmware, bool is_can = false) {
  const Device device = is_can ? test::belt_device_of(*test::drive_kind("vesc-can")) : test::belt_device();
  PtyEmulator emulator(std::move(firmware), device);
  const Kind driver(lock_step_link(emulator, device, is_can));
  return driver.facts().settings;
}

template <typename Kind>
std::optional<DriveProblem> refusal_of(std::unique_ptr<test::Firmware> firmware) {
  return failure_of([&] { (void)settings_of<Kind>(std::move(firmware)); });
}

/// Of the belt, with what the drive tells.
std::vector<Finding> findings_of(const DriveSettings& drive, const DeviceParameters& parameters) {
  RigSession session;
  session.drive = drive;
  remark(session, Device(parameters));
  std::vector<Finding> findings;
  for (const Remark& each : session.remarks) findings.push_back(each.finding.value());
  return findings;
}

TEST(VescSettings, SmallCurrentsThatItDropsAreAFindingWithTheirForce) {
  for (const bool is_can : {false, true}) {
    const VescFirmware::Settings set{.least_current = 0.05};
    auto firmware = is_can ? std::unique_ptr<test::Firmware>(
                                 std::make_unique<test::CanAdapterFirmware>(std::make_unique<VescCanNode>(set)))
                           : std::make_unique<VescFirmware>(set);
    const DriveSettings found = settings_of<VescDriver>(std::move(firmware), is_can);
    const DeviceParameters belt = test::belt_device().parameters();
    EXPECT_EQ(found.firmware, "6.06");
    EXPECT_FALSE(found.are_unknown);
    EXPECT_NEAR(found.least_current.value(), 0.05, 1e-8) << "as a float";
    EXPECT_NEAR(found.least_force.value(), 0.05 * 0.05 / std::abs(belt.driver->torque_per_force()), 1e-6);
    const auto findings = findings_of(found, belt);
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings[0].code, FindingCode::drive_drops_small_forces);
    EXPECT_EQ(findings[0].evidence[0].value, found.least_force);
    EXPECT_EQ(findings[0].evidence[1].value, found.least_current);
  }
  EXPECT_TRUE(findings_of({.least_force = 0.0}, test::belt_device().parameters()).empty());
}

// Its position is the motor's divided by that, modulo a turn.
TEST(VescSettings, ADividedAngleIsCountedInTurnsOfTheMotor) {
  const Device device = test::belt_device();
  for (const double division : {1.5, 2.0, 7.0}) {
    PtyEmulator emulator(std::make_unique<VescFirmware>(VescFirmware::Settings{.angle_division = division}), device);
    emulator.set_fault(PtyEmulator::Fault::no_watchdog);
    VescDriver driver(lock_step_link(emulator, device));
    HybridLoop expected(device, {});
    const MotorDrive& drive = *device.parameters().driver;
    driver.arm();
    ASSERT_TRUE(driver.measure());
    const double force = 0.08 * *drive.torque_constant / drive.torque_per_force();
    for (int k = 0; k < 200; ++k) {
      driver.command(force);
      expected.move(force);
      const auto position = driver.measure();
      ASSERT_TRUE(position) << division << ", " << k;
      ASSERT_NEAR(*position, expected.measure(), division * 1e-9) << k;
    }
    EXPECT_GT(std::abs(expected.measure()), 10 * 0.0125) << "many turns";
  }
}

TEST(VescSettings, FirmwareBefore6IsRefusedAndItsNumberTold) {
  const auto refused =
      refusal_of<VescDriver>(std::make_unique<VescFirmware>(VescFirmware::Settings{.major = 5, .minor = 3}));
  EXPECT_EQ(refused, (DriveProblem{vesc_firmware, {}, {{"firmware", "5.03"}}}));
}

TEST(VescSettings, OfAnotherFirmwareTheyAreNotRead) {
  const DriveSettings found = settings_of<VescDriver>(
      std::make_unique<VescFirmware>(VescFirmware::Settings{.major = 8, .minor = 1, .signature = 1}));
  EXPECT_TRUE(found.are_unknown);
  EXPECT_FALSE(found.least_force);
  const auto findings = findings_of(found, test::belt_device().parameters());
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].code, FindingCode::drive_settings_unknown);
  EXPECT_EQ(findings[0].subjects[0].text, "8.01");
}

std::unique_ptr<MoteusFirmware> moteus_with(const char* name, double value) {
  auto firmware = std::make_unique<MoteusFirmware>();
  firmware->set(name, value);
  return firmware;
}

TEST(MoteusSettings, WhatItDoesAfterItsWatchdogIsTold) {
  for (const int mode : {0, 12, 15}) {
    const DriveSettings found = settings_of<MoteusDriver>(moteus_with("servo.timeout_mode", mode));
    EXPECT_EQ(found.firmware, "1.1.0");
    EXPECT_EQ(found.mode_after_watchdog, mode);
    const auto findings = findings_of(found, test::belt_device().parameters());
    ASSERT_EQ(findings.size(), 1U);
    EXPECT_EQ(findings[0].code, FindingCode::drive_after_watchdog);
    EXPECT_EQ(findings[0].evidence[0].value, mode);
  }
}

// A host that died would leave a motor that holds its place with the drive's own gains.
TEST(MoteusSettings, OneThatHoldsItsPositionAfterItsWatchdogIsRefused) {
  const auto refused = refusal_of<MoteusDriver>(moteus_with("servo.timeout_mode", 10.0));
  EXPECT_EQ(refused, (DriveProblem{moteus_holds, {{"id", 1.0}, {"mode", 10.0}}}));
}

TEST(MoteusSettings, ModesOfAnotherHostAreToldApart) {
  const Device device = test::belt_device();
  for (const int mode : {12, 15}) {
    auto firmware = std::make_unique<MoteusFirmware>();
    MoteusFirmware& moteus = *firmware;
    PtyEmulator emulator(std::move(firmware), device);
    emulator.set_fault(PtyEmulator::Fault::no_watchdog);
    MoteusDriver driver(lock_step_link(emulator, device));
    driver.arm();
    ASSERT_TRUE(driver.measure());
    moteus.mode_of_other_host = mode;
    EXPECT_TRUE(test::within(std::chrono::seconds(10), [&] { return !driver.measure(); }));
    EXPECT_EQ(driver.trouble(), (DriveProblem{moteus_let_go, {{"id", 1.0}, {"mode", 1.0 * mode}}}));
    const auto refused = failure_of([&] { driver.arm(); });
    EXPECT_EQ(code_of(refused), moteus_other_mode);
    EXPECT_EQ(number_of(refused, "mode"), mode);
  }
}

// By the frequency at which it passes 3 dB less since ABI 0x010c, by that of its poles before.
TEST(PositionFilter, OfAMoteusIsThatOfItsOutputsSource) {
  const char* key = "motor_position.sources.0.pll_filter_hz";
  EXPECT_NEAR(settings_of<MoteusDriver>(moteus_with(key, 400.0)).tracking_bandwidth.value(),
              2.0 * std::numbers::pi * 400.0 / 2.48, 1e-3);
  auto older = moteus_with(key, 400.0);
  older->set_version(0x00010b);
  const DriveSettings found = settings_of<MoteusDriver>(std::move(older));
  EXPECT_EQ(found.firmware, "0.1.11");
  EXPECT_NEAR(found.tracking_bandwidth.value(), 2.0 * std::numbers::pi * 400.0, 1e-3);
  EXPECT_EQ(settings_of<MoteusDriver>(moteus_with(key, 0.0)).tracking_bandwidth, 0.0);
  auto other = moteus_with(key, 400.0);
  other->set("motor_position.output.source", 1.0);
  other->set("motor_position.sources.1.pll_filter_hz", 248.0);
  EXPECT_NEAR(settings_of<MoteusDriver>(std::move(other)).tracking_bandwidth.value(), 2.0 * std::numbers::pi * 100.0,
              1e-3);
}

TEST(PositionFilter, OfAnOdriveIsItsEncodersBandwidth) {
  auto firmware = std::make_unique<OdriveFirmware>();
  firmware->set("encoder.config.bandwidth", 1000.0);
  EXPECT_EQ(settings_of<OdriveDriver>(std::move(firmware)).tracking_bandwidth, 1000.0);
  auto newer = std::make_unique<OdriveFirmware>(OdriveFirmware::Version::v0_6);
  newer->set("config.encoder_bandwidth", 500.0);
  EXPECT_EQ(settings_of<OdriveDriver>(std::move(newer)).tracking_bandwidth, 500.0);
}

TEST(PositionFilter, OfASimplefocIsALag) {
  auto firmware = std::make_unique<SimplefocFirmware>();
  firmware->angle_lag = 0.004;
  EXPECT_EQ(settings_of<SimplefocDriver>(std::move(firmware)).position_lag, 0.004);
}

TEST(PositionFilter, IsSaidWhereItsFileDoesNot) {
  DeviceParameters file = test::belt_device().parameters();
  const auto filtered = [&](const DriveSettings& drive) {
    const auto findings = findings_of(drive, file);
    return !findings.empty() && findings[0].code == FindingCode::drive_filters_position;
  };
  const DriveSettings odrive{.tracking_bandwidth = 1000.0};
  EXPECT_TRUE(filtered(odrive));
  EXPECT_EQ(findings_of(odrive, file)[0].key, "sensor.tracking_bandwidth");
  EXPECT_FALSE(filtered({.tracking_bandwidth = 0.0})) << "it has none";
  EXPECT_FALSE(filtered({.tracking_bandwidth = 100.1 / file.loop.sampling_period})) << "nor one that matters";
  EXPECT_TRUE(filtered({.tracking_bandwidth = 99.9 / file.loop.sampling_period}));
  file.sensor.tracking_bandwidth = 1000.0;
  EXPECT_FALSE(filtered(odrive)) << "as its file says";
  file.sensor.tracking_bandwidth = 900.0;
  EXPECT_TRUE(filtered(odrive));
  EXPECT_FALSE(filtered({.tracking_bandwidth = 1000.0, .is_filter_assumed = true})) << "the file knows better";
  file.sensor.tracking_bandwidth = 0.0;
  EXPECT_TRUE(filtered({.tracking_bandwidth = 1000.0, .is_filter_assumed = true}));
  EXPECT_TRUE(filtered({.position_lag = 0.004}));
  EXPECT_EQ(findings_of({.position_lag = 0.004}, file)[0].key, "actuator.time_constant");
  file.actuator.time_constant = 0.005;
  EXPECT_FALSE(filtered({.position_lag = 0.004})) << "the actuator's, and this one's";
}

}  // namespace
}  // namespace zwidth::rig
