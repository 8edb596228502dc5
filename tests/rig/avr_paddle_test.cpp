// firmware/examples/hapkit_paddle as simavr runs it, instruction by instruction (tests/avr_board): the loop through its serial
// line, its sensor and the pins of its motor.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include "rig/drive_failure.hpp"
#include "rig/measured_as_predicted.hpp"
#include "rig/microcontroller_driver.hpp"
#include "rig/printing_process.hpp"
#include "rig/rig_host.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::rig {
namespace {

constexpr double paddle_period = 1e-3;
constexpr double paddle_watchdog = 0.1;

Device paddle() {
  return read_device_file(ZWIDTH_SOURCE_DIR "/firmware/examples/hapkit_paddle/hapkit_paddle.toml").value();
}

std::string port_of(const test::PrintingProcess& board) {
  std::string line = board.line();
  return line.substr(0, line.find('\n'));
}

/// Its time is the board's, and moves with the host's frames.
std::unique_ptr<MicrocontrollerDriver> driver_of(const std::string& port) {
  return std::make_unique<MicrocontrollerDriver>(
      SerialLink{.port = port, .drive = {}, .sampling_period = paddle_period, .lock_step = true});
}

// 16 000 cycles of its processor between two questions: question, answer and force are over within them.
TEST(AvrPaddle, ClosesTheLoopAtOneKilohertz) {
  const test::PrintingProcess board({ZWIDTH_AVR_BOARD, ZWIDTH_AVR_PADDLE, "step", "1e-3"});
  const auto driver = driver_of(port_of(board));
  EXPECT_EQ(driver->facts().watchdog, paddle_watchdog);
  driver->arm();
  for (int i = 0; i < 500; ++i) {
    ASSERT_TRUE(driver->measure()) << testing::PrintToString(driver->trouble());
    driver->command(i % 2 == 0 ? 0.5 : -0.6);
  }
  double delay = 0.0;
  double jitter = 0.0;
  const std::string line = board.line();
  ASSERT_EQ(std::sscanf(line.c_str(), "delay %lf jitter %lf", &delay, &jitter), 2) << line;
  EXPECT_LT(delay, paddle_period) << "from a reading of the sensor to the motor";
  EXPECT_NEAR(delay, paddle().loop().delay, 0.05e-3) << "as its device file says";
  EXPECT_LT(jitter, 0.05e-3);
}

TEST(AvrPaddle, TheLimitIsThePredictedOne) {
  const test::PrintingProcess board({ZWIDTH_AVR_BOARD, ZWIDTH_AVR_PADDLE, "step", "1e-3"});
  const auto driver = driver_of(port_of(board));
  expect_limit(paddle(), *driver);
}

// Killed or cut off: nothing comes any more. The board's own cycles tell how long it took.
TEST(AvrPaddle, LetsGoWithinItsWatchdogWhereNothingComes) {
  const test::PrintingProcess board({ZWIDTH_AVR_BOARD, ZWIDTH_AVR_PADDLE, "clock"});
  const auto driver = driver_of(port_of(board));
  driver->arm();
  driver->command(1.0);
  double silence = 0.0;
  const std::string line = board.line();
  ASSERT_EQ(std::sscanf(line.c_str(), "zero %lf", &silence), 1) << line;
  EXPECT_GE(silence, paddle_watchdog - 1e-3);
  EXPECT_LE(silence, paddle_watchdog + 2e-3) << "it counts milliseconds";
}

TEST(AvrPaddle, ItsWatchdogIsProved) {
  const test::PrintingProcess board({ZWIDTH_AVR_BOARD, ZWIDTH_AVR_PADDLE, "clock"});
  const auto driver = driver_of(port_of(board));
  // On a machine that is busy, a second of the board's takes longer.
  EXPECT_TRUE(test::within(std::chrono::seconds(60), [&] { return driver->proves_watchdog() == true; }));
  ASSERT_TRUE(driver->facts().watchdog);
  EXPECT_GE(*driver->facts().watchdog, paddle_watchdog);
  EXPECT_LE(*driver->facts().watchdog, paddle_watchdog + 5e-3);
}

}  // namespace
}  // namespace zwidth::rig
