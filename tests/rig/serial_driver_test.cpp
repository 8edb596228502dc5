// Each driver of a serial line or a CAN bus against its drive's emulated firmware on a pseudo-terminal.
#include "rig/serial_driver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include "rig/drive_kinds.hpp"
#include "rig/measured_as_predicted.hpp"
#include "rig/open_driver.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/rig_actions.hpp"
#include "rig/rig_host.hpp"
#include "rig/serial_device.hpp"
#include "zwidth/error.hpp"
#include "zwidth/rig/serial_rate.hpp"

namespace zwidth::rig {
namespace {

using test::belt_device;
using test::DriveKind;
using test::PtyEmulator;
using testing::HasSubstr;
using Fault = PtyEmulator::Fault;

class OnDrive : public testing::TestWithParam<DriveKind> {
 protected:
  [[nodiscard]] static SerialLink link(const PtyEmulator& emulator, const Device& device, bool lock_step) {
    return {emulator.path(), *device.parameters().driver, device.loop().sampling_period, lock_step};
  }
  [[nodiscard]] static std::string failure(const std::string& name, const Device& device) {
    try {
      (void)open_driver(name, device, {});
      return "";
    } catch (const DriverFailed& problem) {
      return problem.what();
    } catch (const Error& problem) {
      return problem.what();
    }
  }
  const Device device = test::belt_device_of(GetParam());
  const bool is_on_bus = GetParam().name.ends_with("-can");
};

// Over the line the same numbers as without it: the drive moves one period with each force, at a rate that its line
// carries at the speed that it has by default. A machine that pauses would make a watchdog bite.
TEST_P(OnDrive, TheLimitOverTheLine) {
  PtyEmulator emulator(GetParam().firmware(), device);
  emulator.set_fault(Fault::no_watchdog);
  const auto driver = GetParam().driver(link(emulator, device, true));
  const DriverFacts& facts = driver->facts();
  const double time = facts.bytes_per_cycle / *facts.byte_rate + facts.bus_time_per_cycle;
  ASSERT_LT(time, serial_share_of_cycle * device.loop().sampling_period);
  expect_limit(device, *driver);
  EXPECT_TRUE(test::within(std::chrono::seconds(5), [&] { return emulator.motor().force() == 0.0; }));
}

TEST_P(OnDrive, IdentificationOverTheLine) {
  PtyEmulator emulator(GetParam().firmware(), device);
  emulator.set_fault(Fault::no_watchdog);
  expect_identified(device, *GetParam().driver(link(emulator, device, true)));
}

TEST_P(OnDrive, TheRelayOverTheLine) {
  PtyEmulator emulator(GetParam().firmware(), device);
  emulator.set_fault(Fault::no_watchdog);
  expect_relay(device, *GetParam().driver(link(emulator, device, true)));
}

TEST_P(OnDrive, TheWatchdogIsProvedBySilence) {
  PtyEmulator emulator(GetParam().firmware(), device);
  const auto driver = GetParam().driver(link(emulator, device, true));
  EXPECT_EQ(driver->proves_watchdog(), GetParam().has_watchdog);
  EXPECT_EQ(emulator.motor().times_let_go(), GetParam().has_watchdog ? 1 : 0);
  EXPECT_EQ(emulator.motor().nonzero_forces(), 0) << "with no force at all";
  driver->arm();
  const MotorDrive& drive = *device.parameters().driver;
  const double force = -0.12 * *drive.torque_constant / drive.torque_per_force();  // whole milliamperes
  driver->command(force);
  ASSERT_TRUE(driver->measure());
  EXPECT_NEAR(emulator.motor().force(), force, 1e-5 * force) << "units, gear and sign";
  driver->disarm();
  driver->command(force);
  EXPECT_TRUE(test::within(std::chrono::seconds(5), [&] { return emulator.motor().force() == 0.0; }));
}

// On a busy machine: answers that come after their question was given up are not taken for those of the next one, and
// a watchdog that bites meanwhile does not keep the drive from being armed.
TEST_P(OnDrive, AWatchdogIsProvedThoughAnswersAreLate) {
  if (!GetParam().has_watchdog) return;
  PtyEmulator emulator(GetParam().firmware(), device);
  const auto driver = GetParam().driver(link(emulator, device, false));
  emulator.set_answer_delay(130);  // ms: longer than the patience of 100
  emulator.set_fault(Fault::late);
  EXPECT_EQ(driver->proves_watchdog(), true);
  emulator.set_fault(Fault::none);
  driver->arm();
  EXPECT_TRUE(driver->measure());
  EXPECT_EQ(emulator.motor().nonzero_forces(), 0);
}

TEST_P(OnDrive, AWatchdogThatDoesNotBiteIsNone) {
  PtyEmulator emulator(GetParam().firmware(), device);
  emulator.set_fault(Fault::no_watchdog);
  const auto driver = GetParam().driver(link(emulator, device, false));
  EXPECT_EQ(driver->proves_watchdog(), false);
  EXPECT_FALSE(driver->facts().watchdog);
}

TEST_P(OnDrive, APositionIsNeverAPeriodOld) {
  const Device slow = test::belt_device_of(GetParam(), 0.04);
  PtyEmulator emulator(GetParam().firmware(), slow);
  const auto driver = GetParam().driver(link(emulator, slow, false));
  driver->arm();
  ASSERT_TRUE(driver->measure());
  emulator.set_fault(Fault::late);  // each answer by 60 ms: into the cycle after the next
  for (int k = 0; k < 6; ++k) EXPECT_FALSE(driver->measure()) << k;
}

// The drive was asked again, and the answer to the question before it, which comes after all, was taken for the new one's.
TEST_P(OnDrive, APositionIsOfTheQuestionAfterALostAnswer) {
  const Device slow = test::belt_device_of(GetParam(), 0.04);
  PtyEmulator emulator(GetParam().firmware(), slow);
  emulator.set_fault(Fault::no_watchdog);
  const auto driver = GetParam().driver(link(emulator, slow, false));
  driver->allow_missed(2);  // an answer counts as lost after half a cycle
  driver->arm();
  ASSERT_TRUE(driver->measure());
  const MotorDrive& drive = *slow.parameters().driver;
  for (int k = 0; k < 3; ++k) {
    emulator.set_answer_delay(50);  // into the next cycle's 32 ms
    emulator.set_fault(Fault::late);
    ASSERT_FALSE(driver->measure());
    emulator.set_fault(Fault::no_watchdog);
    driver->command(1.0);  // it moves after that question
    std::optional<double> position;
    for (int i = 0; i < 20 && !position; ++i) position = driver->measure();  // a busy machine hands it on late
    ASSERT_TRUE(position);
    EXPECT_NEAR(*position, emulator.motor().turns() * drive.position_per_turn(), 1e-6) << k;
    ASSERT_TRUE(driver->measure());
  }
}

TEST_P(OnDrive, TellsWhatIsInTheWay) {
  const std::string name(GetParam().name);
  PtyEmulator emulator(GetParam().firmware(), device);
  EXPECT_THAT(failure(name + ":/dev/null", device), HasSubstr("is no serial port"));
  EXPECT_THAT(failure(name + ":/no/such/port", device), HasSubstr("No such file"));
  EXPECT_THAT(failure(name + ":", device), HasSubstr("names no port"));
  const auto at = [&](double period) { return test::belt_device_of(GetParam(), period); };
  const bool is_fast = name == "serial" || name == "moteus-can";
  const std::string fast = failure(name + ":" + emulator.path(), at(is_fast ? 3e-4 : 1e-3));
  EXPECT_THAT(fast, HasSubstr("the line is too slow"));
  EXPECT_THAT(fast, HasSubstr("loop.sampling_period to "));
  const bool has_no_faster = name == "moteus-can" || name == "vesc-can";  // at their bus's fastest
  if (!has_no_faster) {
    EXPECT_THAT(fast, HasSubstr("set the drive and driver.baud to"));
  }
  EXPECT_THAT(failure(name + ":" + emulator.path(), at(0.6)), HasSubstr(GetParam().has_watchdog ? "lets go" : ""));
  DeviceParameters other_speed = device.parameters();
  other_speed.driver->baud = is_on_bus ? 125000 : 460800;
  EXPECT_THAT(failure(name + ":" + emulator.path(), Device(other_speed)), HasSubstr("that driver.baud is the "));
  other_speed.driver->baud = 1234567;
  EXPECT_THAT(failure(name + ":" + emulator.path(), Device(other_speed)),
              HasSubstr(is_on_bus ? "one of 10000, 20000" : "one of 1200, 2400"));
  DeviceParameters bare = device.parameters();
  bare.driver.reset();
  if (name != "serial") {  // which speaks of the device
    EXPECT_THAT(failure(name + ":" + emulator.path(), Device(bare)), HasSubstr("driver: is missing"));
  }
  const auto driver = GetParam().driver(link(emulator, device, false));
  EXPECT_THAT(failure(name + ":" + emulator.path(), device), HasSubstr("another rig"));
}

// What it says is modulo a turn.
TEST(VescDriver, CountsTurns) {
  const Device device = belt_device();
  PtyEmulator emulator(std::make_unique<test::VescFirmware>(), device);
  emulator.set_fault(Fault::no_watchdog);
  VescDriver driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
  HybridLoop expected(device, {});
  const MotorDrive& drive = *device.parameters().driver;
  driver.arm();
  ASSERT_TRUE(driver.measure());
  for (int k = 0; k < 200; ++k) {
    const double force = 0.08 * *drive.torque_constant / drive.torque_per_force();
    driver.command(force);
    expected.move(force);
    const auto position = driver.measure();
    ASSERT_TRUE(position) << k;
    ASSERT_NEAR(*position, expected.measure(), 1e-9) << k;
  }
  EXPECT_GT(std::abs(expected.measure()), 10 * 0.0125) << "many turns";
  int answered = 0;
  for (int k = 0; k < 200 && driver.measure(); ++k, ++answered) {
    driver.command(-12.0);
    expected.move(-12.0);
  }
  EXPECT_LT(answered, 200) << "faster than can be told from slower, it has no position";
  EXPECT_FALSE(driver.measure()) << "for good";
  EXPECT_NE(driver.trouble().find("more than 0.25 of a turn from one cycle to the next"), std::string::npos)
      << driver.trouble();
}

// What the device file lacks is said before a port is touched: this one does not exist.
TEST(SerialDriver, NeedsATorqueConstantBeforeItsPort) {
  DeviceParameters parameters = belt_device().parameters();
  parameters.driver->torque_constant.reset();
  parameters.driver->torque_per_volt.reset();
  for (const char* name : {"vesc:/no/such/port", "simplefoc:/no/such/port"}) {
    try {
      (void)open_driver(name, Device(parameters), {});
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("driver.torque_constant: is missing")) << name;
    }
  }
}

TEST(SerialDriver, NeedsAnIdThatTheDriveHasBeforeItsPort) {
  const auto refusal = [](const char* name, int id) -> std::string {
    DeviceParameters parameters = belt_device().parameters();
    parameters.driver->id = id;
    try {
      (void)open_driver(name, Device(parameters), {});
    } catch (const DriverFailed& problem) {
      return problem.what();
    }
    return "";
  };
  EXPECT_THAT(refusal("odrive:/no/such/port", 2), HasSubstr("driver.id is 2; an ODrive has the axes 0 and 1"));
  EXPECT_THAT(refusal("moteus:/no/such/port", 0), HasSubstr("driver.id is 0; a moteus has 1 to 127"));
  EXPECT_THAT(refusal("odrive:/no/such/port", 1), HasSubstr("No such file"));
  EXPECT_THAT(refusal("moteus:/no/such/port", 127), HasSubstr("No such file"));
}

// The unit of a target is the sketch's.
TEST(SimplefocDriver, TakesTheUnitOfTheSketch) {
  const Device device = belt_device();
  const auto force_for_3 = [&](const std::string& torque, double resistance) {
    PtyEmulator emulator(std::make_unique<test::SimplefocFirmware>(torque, resistance), device);
    SimplefocDriver driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
    driver.arm();
    driver.command(3.0);
    EXPECT_TRUE(driver.measure());
    return emulator.motor().force();
  };
  EXPECT_NEAR(force_for_3("volt", 0.0), 3.0, 3e-5);
  EXPECT_NEAR(force_for_3("dc curr", 2.0), 3.0, 3e-5);
  EXPECT_THROW(force_for_3("volt", 2.0), DriverFailed) << "its unit depends on the version";
  EXPECT_THROW(force_for_3("thought", 0.0), DriverFailed);
}

// A sketch may disable the motor when nothing comes: then it needs no --no-watchdog.
TEST(SimplefocDriver, ProvesTheTimeoutOfASketch) {
  const Device device = belt_device();
  for (const auto& [timeout, proved] : {std::pair{80, 0.1}, {150, 0.2}, {2000, 0.0}, {0, 0.0}}) {
    PtyEmulator emulator(std::make_unique<test::SimplefocFirmware>("foc curr", 0.0, std::chrono::milliseconds(timeout)),
                         device);
    SimplefocDriver driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
    EXPECT_EQ(driver.proves_watchdog(), proved > 0.0) << timeout;
    EXPECT_EQ(driver.facts().watchdog.value_or(0.0), proved) << timeout;
    EXPECT_EQ(emulator.motor().nonzero_forces(), 0);
    driver.arm();
    EXPECT_TRUE(driver.measure());
  }
}

// It takes a checksum for a flag that it does not know, and adds flags of its own.
TEST(MoteusDriver, BehindAnAdapterThatKnowsNoChecksums) {
  const Device device = belt_device();
  PtyEmulator emulator(std::make_unique<test::MoteusFirmware>(true), device);
  MoteusDriver driver({emulator.path(), *device.parameters().driver, device.loop().sampling_period, true});
  EXPECT_EQ(driver.proves_watchdog(), true);
  driver.arm();
  driver.command(-2.0);
  EXPECT_TRUE(driver.measure());
  EXPECT_NEAR(emulator.motor().force(), -2.0, 0.002);
}

INSTANTIATE_TEST_SUITE_P(Drive, OnDrive, testing::ValuesIn(test::drive_kinds),
                         [](const auto& kind) { return std::string(kind.param.name); });
INSTANTIATE_TEST_SUITE_P(Can, OnDrive, testing::ValuesIn(test::can_drive_kinds), test::name_of_bus_drive);

}  // namespace
}  // namespace zwidth::rig
