// Drives on CAN buses behind each kind of adapter, and what their firmware differs in.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <utility>

#include "rig/drive_failure.hpp"
#include "rig/drive_kinds.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/rig_actions.hpp"
#include "rig/rig_host.hpp"

namespace zwidth::rig {
namespace {

using enum DriveProblemCode;
using test::CanAdapterFirmware;
using test::code_of;
using test::DriveKind;
using test::failure_of;
using test::number_of;
using test::OdriveCanNode;
using test::PtyEmulator;
using test::subject_of;
using Adapter = CanAdapterFirmware::Kind;
using Fault = PtyEmulator::Fault;

template <typename Node>
std::unique_ptr<test::Firmware> behind(Adapter adapter) {
  return std::make_unique<CanAdapterFirmware>(std::make_unique<Node>(), adapter);
}

SerialLink link_to(const PtyEmulator& emulator, const Device& device, bool lock_step = false) {
  return {.port = emulator.path(),
          .drive = *device.parameters().driver,
          .sampling_period = device.loop().sampling_period,
          .lock_step = lock_step,
          .is_can = true};
}

/// A force goes out, and a position comes back.
void expect_force(Driver& driver, PtyEmulator& emulator, const MotorDrive& drive) {
  EXPECT_EQ(driver.proves_watchdog(), true);
  driver.arm();
  const double force = -0.12 * 0.05 / drive.torque_per_force();  // whole milliamperes
  driver.command(force);
  ASSERT_TRUE(driver.measure());
  EXPECT_NEAR(emulator.motor().force(), force, 1e-5 * force);
  driver.disarm();
  EXPECT_TRUE(test::within(std::chrono::seconds(5), [&] { return emulator.motor().force() == 0.0; }));
}

// One that confirms every frame, and one of another language.
TEST(CanAdapters, OfEachKindCarryAnOdrive) {
  const Device device = test::belt_device();
  for (const Adapter adapter : {Adapter::lawicel, Adapter::fdcanusb}) {
    SCOPED_TRACE(static_cast<int>(adapter));
    PtyEmulator emulator(behind<OdriveCanNode>(adapter), device);
    OdriveCanDriver driver(link_to(emulator, device));
    expect_force(driver, emulator, *device.parameters().driver);
  }
}

TEST(CanAdapters, OfEachKindCarryAVesc) {
  const Device device = test::belt_device_of(*test::drive_kind("vesc-can"));
  for (const Adapter adapter : {Adapter::lawicel, Adapter::fdcanusb}) {
    SCOPED_TRACE(static_cast<int>(adapter));
    PtyEmulator emulator(behind<test::VescCanNode>(adapter), device);
    VescDriver driver(link_to(emulator, device));
    expect_force(driver, emulator, *device.parameters().driver);
  }
}

TEST(CanAdapters, AnFdcanusbCarriesAMoteusAndALawicelHasNoCanFd) {
  const Device device = test::belt_device();
  {
    PtyEmulator emulator(behind<test::MoteusCanNode>(Adapter::fdcanusb), device);
    MoteusDriver driver(link_to(emulator, device));
    expect_force(driver, emulator, *device.parameters().driver);
  }
  PtyEmulator emulator(behind<test::MoteusCanNode>(Adapter::lawicel), device);
  const auto refused = failure_of([&] { MoteusDriver driver(link_to(emulator, device)); });
  EXPECT_EQ(code_of(refused), adapter_without_can_fd);
  EXPECT_EQ(subject_of(refused, "command"), "Y5");
}

// An adapter that is not there (a board that says nothing) looks as one whose bus is not.
TEST(CanAdapters, TellWhereNothingIsHeard) {
  const Device device = test::belt_device();
  PtyEmulator emulator(behind<OdriveCanNode>(Adapter::canable), device);
  emulator.set_fault(Fault::silent);
  const auto refused = failure_of([&] { OdriveCanDriver driver(link_to(emulator, device)); });
  EXPECT_EQ(refused, (DriveProblem{no_heartbeat, {{"node", 0.0}}}));
}

TEST(OdriveCanDriver, OfFirmware6HasAnotherWatchdog) {
  const Device device = test::belt_device();
  PtyEmulator emulator(std::make_unique<CanAdapterFirmware>(std::make_unique<OdriveCanNode>(6)), device);
  OdriveCanDriver driver(link_to(emulator, device));
  expect_force(driver, emulator, *device.parameters().driver);
  EXPECT_GT(driver.facts().watchdog.value(), 0.1);
  EXPECT_LT(driver.facts().watchdog.value(), 1.2);
}

// As an ODrive does by default, every 10 ms: such a position would pass for the answer to a question after it.
TEST(OdriveCanDriver, RefusesPositionsThatNobodyAskedFor) {
  const Device device = test::belt_device();
  auto node = std::make_unique<OdriveCanNode>();
  node->encoder_rate = std::chrono::milliseconds(10);
  PtyEmulator emulator(std::make_unique<CanAdapterFirmware>(std::move(node)), device);
  EXPECT_EQ(code_of(failure_of([&] { OdriveCanDriver driver(link_to(emulator, device)); })), sends_unasked);
  EXPECT_EQ(emulator.motor().forces(), 0);
}

TEST(OdriveCanDriver, StandsOnAnErrorBeforeAnyForce) {
  const Device device = test::belt_device();
  PtyEmulator emulator(behind<OdriveCanNode>(Adapter::canable), device);
  emulator.set_fault(Fault::failed_drive);
  const auto refused = failure_of([&] { OdriveCanDriver driver(link_to(emulator, device)); });
  EXPECT_EQ(code_of(refused), odrive_fault);
  EXPECT_EQ(number_of(refused, "node"), 0.0);
  EXPECT_GT(number_of(refused, "error"), 0.0);
}

// The bits of its frame leave after the adapter has them, those of SLCAN's line after the system has: the emulated bus takes
// its time by the clock.
TEST(DelayOfBus, IsThatOfFramesAndOfTheLine) {
  const Device device = test::belt_device(0.04);
  PtyEmulator emulator(behind<OdriveCanNode>(Adapter::canable), device, {.is_paced = true});
  double truth = 0.0;
  {
    OdriveCanDriver driver(link_to(emulator, device));
    EXPECT_NEAR(driver.facts().force_bus_time, 95.0 / 250e3, 1e-12) << "four bytes, every bit stuffed";
    EXPECT_NEAR(driver.facts().bus_time_per_cycle, (55.0 + 135.0 + 95.0) / 250e3, 1e-12);
    EXPECT_EQ(driver.facts().force_bytes, 14.0) << "t00E4, eight digits and the end";
    driver.arm();
    for (int k = 0; k < 40; ++k) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      if (!driver.measure()) continue;
      if (k == 0) (void)emulator.motor().mean_delay();  // of the forces that armed it
      driver.command(0.0);
    }
    truth = emulator.motor().mean_delay();  // from the drive's own reading
  }
  OdriveCanDriver driver(link_to(emulator, device));
  RigOptions options;
  options.nudge = false;
  const RigCheck found = check(device, driver, options, 1.0);
  ASSERT_EQ(found.session.stop, StopReason::none) << explanation(found.session);
  // The whole of a cycle on the wire, not less than what is between the drive's reading and its force.
  EXPECT_GE(found.session.timing.delay.p50, (55.0 + 135.0 + 95.0) / 250e3);
  EXPECT_LT(std::abs(found.session.timing.delay.p50 - truth), 55.0 / 250e3 + 0.015);
}

}  // namespace
}  // namespace zwidth::rig
