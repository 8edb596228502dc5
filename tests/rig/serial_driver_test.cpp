// Each driver of a serial line or a CAN bus against its drive's emulated firmware on a pseudo-terminal.
#include "rig/serial_driver.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <string>

#include "rig/drive_failure.hpp"
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

using enum DriveProblemCode;
using test::belt_device;
using test::code_of;
using test::DriveKind;
using test::failure_of;
using test::number_of;
using test::PtyEmulator;
using test::subject_of;
using Fault = PtyEmulator::Fault;

class OnDrive : public testing::TestWithParam<DriveKind> {
 protected:
  [[nodiscard]] static SerialLink link(const PtyEmulator& emulator, const Device& device, bool lock_step) {
    return {emulator.path(), *device.parameters().driver, device.loop().sampling_period, lock_step};
  }
  [[nodiscard]] static std::optional<DriveProblem> failure(const std::string& name, const Device& device) {
    return failure_of([&] { (void)open_driver(name, device, {}); });
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
  EXPECT_EQ(code_of(failure(name + ":/dev/null", device)), not_a_serial_port);
  EXPECT_EQ(code_of(failure(name + ":/no/such/port", device)), port_not_opened);
  EXPECT_EQ(code_of(failure(name + ":", device)), is_on_bus ? no_adapter_named : no_port_named);
  const auto at = [&](double period) { return test::belt_device_of(GetParam(), period); };
  const bool is_fast = name == "serial" || name == "moteus-can";
  const double fast = is_fast ? 3e-4 : 1e-3;
  const auto slow_line = failure(name + ":" + emulator.path(), at(fast));
  EXPECT_EQ(code_of(slow_line), is_on_bus ? bus_too_slow : line_too_slow);
  EXPECT_DOUBLE_EQ(number_of(slow_line, "wanted_hz").value(), 1.0 / fast);
  EXPECT_LT(number_of(slow_line, "carried_hz").value(), 1.0 / fast);
  EXPECT_GE(number_of(slow_line, "period").value(), 1.0 / (number_of(slow_line, "carried_hz").value() + 1.0));
  const bool has_no_faster = name == "moteus-can" || name == "vesc-can";  // at their bus's fastest
  if (!has_no_faster) {
    EXPECT_GT(number_of(slow_line, is_on_bus ? "sufficient_rate" : "sufficient_baud").value(),
              number_of(slow_line, is_on_bus ? "rate" : "baud").value());
  }
  if (GetParam().has_watchdog) {
    const auto slow_loop = failure(name + ":" + emulator.path(), at(0.6));
    EXPECT_EQ(code_of(slow_loop), name == "serial" ? sketch_watchdog : watchdog_below_cycle);
    EXPECT_LT(number_of(slow_loop, "watchdog").value(), 2.0 * 0.6);
  }
  DeviceParameters other_speed = device.parameters();
  other_speed.driver->baud = is_on_bus ? 125000 : 460800;
  const auto silence = code_of(failure(name + ":" + emulator.path(), Device(other_speed)));
  EXPECT_TRUE(silence == silent || silence == silent_on_bus || silence == no_heartbeat ||
              silence == silent_microcontroller);
  other_speed.driver->baud = 1234567;
  const auto no_speed = failure(name + ":" + emulator.path(), Device(other_speed));
  EXPECT_EQ(code_of(no_speed), is_on_bus ? bit_rate_unknown : speed_unknown);
  EXPECT_EQ(number_of(no_speed, is_on_bus ? "rate" : "baud"), 1234567.0);
  EXPECT_TRUE(subject_of(no_speed, "known").starts_with(is_on_bus ? "10000, 20000" : "1200, 2400"));
  DeviceParameters bare = device.parameters();
  bare.driver.reset();
  if (name != "serial") {  // which speaks of the device
    EXPECT_THROW((void)failure(name + ":" + emulator.path(), Device(bare)), Error);
  }
  const auto driver = GetParam().driver(link(emulator, device, false));
  const auto second = code_of(failure(name + ":" + emulator.path(), device));
  EXPECT_TRUE(second == port_held || second == port_busy);
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
  EXPECT_EQ(code_of(driver.trouble()), turns_not_counted);
  EXPECT_EQ(number_of(driver.trouble(), "most"), 0.25);
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
      EXPECT_EQ(error.code(), ErrorCode::invalid_argument) << name;
    }
  }
}

TEST(SerialDriver, NeedsAnIdThatTheDriveHasBeforeItsPort) {
  const auto refusal = [](const char* name, int id) {
    DeviceParameters parameters = belt_device().parameters();
    parameters.driver->id = id;
    return failure_of([&] { (void)open_driver(name, Device(parameters), {}); });
  };
  EXPECT_EQ(refusal("odrive:/no/such/port", 2),
            (DriveProblem{id_out_of_range, {{"id", 2.0}, {"least", 0.0}, {"most", 1.0}}, {{"drive", "odrive"}}}));
  EXPECT_EQ(refusal("moteus:/no/such/port", 0),
            (DriveProblem{id_out_of_range, {{"id", 0.0}, {"least", 1.0}, {"most", 127.0}}, {{"drive", "moteus"}}}));
  EXPECT_EQ(code_of(refusal("odrive:/no/such/port", 1)), port_not_opened);
  EXPECT_EQ(code_of(refusal("moteus:/no/such/port", 127)), port_not_opened);
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
  EXPECT_EQ(code_of(failure_of([&] { force_for_3("volt", 2.0); })), simplefoc_resistance)
      << "its unit depends on the version";
  const auto thought = failure_of([&] { force_for_3("thought", 0.0); });
  EXPECT_EQ(code_of(thought), simplefoc_torque);
  EXPECT_EQ(subject_of(thought, "said"), "thought");
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
