// What is a microcontroller's alone among the drives on serial lines (serial_driver_test.cpp): sequence numbers, its description, and
// that it takes no force after its watchdog until it is held anew.
#include "rig/microcontroller_driver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>

#include "rig/microcontroller_firmware.hpp"
#include "rig/pty_emulator.hpp"
#include "rig/rig_host.hpp"
#include "rig/serial_device.hpp"

namespace zwidth::rig {
namespace {

using test::MicrocontrollerFirmware;
using test::PtyEmulator;
using testing::HasSubstr;

class OnMicrocontroller : public testing::Test {
 protected:
  [[nodiscard]] SerialLink link(const PtyEmulator& emulator) const {
    return {.port = emulator.path(), .drive = {}, .sampling_period = device.loop().sampling_period};
  }
  [[nodiscard]] std::string refusal(std::unique_ptr<MicrocontrollerFirmware> firmware) const {
    PtyEmulator emulator(std::move(firmware), device);
    try {
      const MicrocontrollerDriver driver(link(emulator));
    } catch (const DriverFailed& problem) {
      return problem.what();
    }
    return "";
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
  EXPECT_THAT(driver.trouble(), HasSubstr("watchdog has let go"));
  const int forces = emulator.motor().forces();
  driver.command(1.0);
  EXPECT_FALSE(driver.measure());
  EXPECT_EQ(emulator.motor().forces(), forces);
  driver.arm();
  EXPECT_EQ(emulator.motor().force(), 0.0);
  driver.disarm();
  EXPECT_TRUE(driver.measure()) << "the last cycles have a position";
  EXPECT_EQ(driver.trouble(), "");
}

TEST_F(OnMicrocontroller, RefusesASketchThatCannotCarryTheLoop) {
  EXPECT_THAT(refusal(std::make_unique<MicrocontrollerFirmware>(50)),
              HasSubstr("lets go after 0.05 s without a force; 0.08 s, two sampling periods, to 1 s"));
  EXPECT_THAT(refusal(std::make_unique<MicrocontrollerFirmware>(2000)), HasSubstr("lets go after 2 s"));
  auto failed = std::make_unique<MicrocontrollerFirmware>();
  failed->begin_with_fault();
  EXPECT_THAT(refusal(std::move(failed)), HasSubstr("stands on fault 40"));
}

}  // namespace
}  // namespace zwidth::rig
