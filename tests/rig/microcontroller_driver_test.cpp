// What is a microcontroller's alone among the drives on serial lines (serial_driver_test.cpp): sequence numbers, its description, and
// that it takes no force after its watchdog until it is held anew.
#include "rig/microcontroller_driver.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <optional>
#include <utility>

#include "rig/drive_failure.hpp"
#include "rig/microcontroller_firmware.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/rig_host.hpp"
#include "rig/serial_device.hpp"

namespace zwidth::rig {
namespace {

using enum DriveProblemCode;
using test::code_of;
using test::MicrocontrollerFirmware;
using test::number_of;
using test::PtyEmulator;

class OnMicrocontroller : public testing::Test {
 protected:
  [[nodiscard]] SerialLink link(const PtyEmulator& emulator) const {
    return {.port = emulator.path(), .drive = {}, .sampling_period = device.loop().sampling_period};
  }
  [[nodiscard]] std::optional<DriveProblem> refusal(std::unique_ptr<MicrocontrollerFirmware> firmware) const {
    PtyEmulator emulator(std::move(firmware), device);
    return test::failure_of([&] { const MicrocontrollerDriver driver(link(emulator)); });
  }
  const Device device = test::belt_device(0.04);
};

// A machine that pauses loses answers, too.
TEST_F(OnMicrocontroller, ALostAnswerCostsItsOwnCycleAlone) {
  PtyEmulator emulator(std::make_unique<MicrocontrollerFirmware>(), device);
  emulator.set_fault(PtyEmulator::Fault::no_watchdog);
  MicrocontrollerDriver driver(link(emulator));
  emulator.set_fault(PtyEmulator::Fault::lost_answers);  // every seventh
  int answered = 0;
  for (int i = 0; i < 12; ++i) answered += driver.measure() ? 1 : 0;
  EXPECT_LE(answered, 11);
  EXPECT_GE(answered, 9);
  emulator.set_fault(PtyEmulator::Fault::late);
  EXPECT_FALSE(driver.measure());
  emulator.set_fault(PtyEmulator::Fault::none);
  EXPECT_TRUE(test::within(std::chrono::seconds(5), [&] { return driver.measure().has_value(); }));
}

// One of them ended the session before it began.
TEST_F(OnMicrocontroller, IsHeldThoughAnAnswerIsLost) {
  PtyEmulator emulator(std::make_unique<MicrocontrollerFirmware>(), device);
  emulator.set_fault(PtyEmulator::Fault::lost_answers);
  MicrocontrollerDriver driver(link(emulator));
  for (int i = 0; i < 7; ++i) driver.arm();
  EXPECT_EQ(driver.proves_watchdog(), true);
}

TEST_F(OnMicrocontroller, TakesNoForceAfterItsWatchdogUntilItIsHeldAnew) {
  PtyEmulator emulator(std::make_unique<MicrocontrollerFirmware>(), device);
  MicrocontrollerDriver driver(link(emulator));
  EXPECT_TRUE(driver.measure()) << "before it is held";
  EXPECT_EQ(driver.facts().watchdog, 0.1);
  driver.arm();
  driver.command(1.0);
  ASSERT_TRUE(test::within(std::chrono::seconds(5), [&] { return emulator.motor().times_let_go() == 1; }));
  EXPECT_FALSE(driver.measure());
  EXPECT_EQ(code_of(driver.trouble()), microcontroller_let_go);
  const int forces = emulator.motor().forces();
  driver.command(1.0);
  EXPECT_FALSE(driver.measure());
  EXPECT_EQ(emulator.motor().forces(), forces);
  driver.arm();
  EXPECT_EQ(emulator.motor().force(), 0.0);
  driver.disarm();
  EXPECT_TRUE(driver.measure()) << "the last cycles have a position";
  EXPECT_FALSE(driver.trouble());
}

TEST_F(OnMicrocontroller, RefusesASketchThatCannotCarryTheLoop) {
  EXPECT_EQ(refusal(std::make_unique<MicrocontrollerFirmware>(50)),
            (DriveProblem{sketch_watchdog, {{"watchdog", 0.05}, {"least", 2 * 0.04}, {"most", 1.0}}}));
  EXPECT_EQ(number_of(refusal(std::make_unique<MicrocontrollerFirmware>(2000)), "watchdog"), 2.0);
  auto failed = std::make_unique<MicrocontrollerFirmware>();
  failed->begin_with_fault();
  EXPECT_EQ(refusal(std::move(failed)), (DriveProblem{microcontroller_fault, {{"fault", 40.0}}}));
}

}  // namespace
}  // namespace zwidth::rig
