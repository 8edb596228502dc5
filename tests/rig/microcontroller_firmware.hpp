#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "rig/firmware.hpp"
#include "zwidth_serial.h"

namespace zwidth::test {

/// A sketch around firmware/zwidth_serial.h, which is the very file that microcontrollers run; it counts as the motor does. A loop that stands still
/// while the line is stalled is one whose watchdog looks when it goes on.
class MicrocontrollerFirmware : public Firmware {
 public:
  static constexpr std::uint8_t fault = 40;

  /// ms
  explicit MicrocontrollerFirmware(std::uint16_t watchdog = 100) { zwidth_serial_begin(&board_, 1e6F, watchdog); }

  [[nodiscard]] int baud() const override { return 1'000'000; }

  [[nodiscard]] std::vector<std::string> receive(std::string_view bytes, EmulatedMotor& motor) override {
    std::vector<std::string> answers;
    for (const char byte : bytes) {
      const std::uint16_t taken = board_.last;
      const std::uint8_t state = board_.state;
      const bool is_asked = zwidth_serial_receive(&board_, static_cast<std::uint8_t>(byte), milliseconds()) != 0;
      tell_letting_go(motor);
      const auto force = static_cast<double>(zwidth_serial_force(&board_, 0.0F, milliseconds()));
      if (board_.last != taken && state == ZWIDTH_SERIAL_HOLDING && !is_asked) {
        motor.set_torque(force * std::abs(motor.drive().torque_per_force()));
      } else if (board_.state != state && force == 0.0) {
        motor.idle();
      }
      if (!is_asked) continue;
      std::array<std::uint8_t, ZWIDTH_SERIAL_MOST> out{};
      const auto position = static_cast<float>(motor.turns() * std::abs(motor.drive().position_per_turn()));
      const std::uint8_t count = zwidth_serial_answer(&board_, position, 0.0F, out.data());
      answers.emplace_back(out.begin(), out.begin() + count);
    }
    return answers;
  }

  void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) override {
    now_ = now;
    if (!is_enabled) board_.fed = milliseconds();
    (void)zwidth_serial_force(&board_, 0.0F, milliseconds());
    tell_letting_go(motor);
  }

  void fail(EmulatedMotor& motor) override {
    zwidth_serial_fail(&board_, fault);
    motor.let_go();
  }

  void begin_with_fault() { zwidth_serial_fail(&board_, fault); }

 private:
  void tell_letting_go(EmulatedMotor& motor) {
    if (board_.times_let_go != times_let_go_) motor.let_go();
    times_let_go_ = board_.times_let_go;
  }
  /// As late as the watchdog's last look, as in a loop.
  [[nodiscard]] std::uint32_t milliseconds() const {
    const auto since = std::chrono::duration_cast<std::chrono::milliseconds>(now_ - begin_);
    return static_cast<std::uint32_t>(since.count());
  }

  zwidth_serial_t board_{};
  std::uint16_t times_let_go_ = 0;
  Clock::time_point begin_ = Clock::now();
  Clock::time_point now_ = begin_;
};

}  // namespace zwidth::test
