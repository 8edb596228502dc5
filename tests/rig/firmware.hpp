#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "rig/emulated_motor.hpp"

namespace zwidth::test {

/// What a drive's firmware does with the bytes of its serial line, as its sources state it.
class Firmware {
 public:
  Firmware() = default;
  Firmware(const Firmware&) = delete;
  Firmware& operator=(const Firmware&) = delete;
  virtual ~Firmware() = default;

  /// Of its line, by default.
  [[nodiscard]] virtual int baud() const = 0;
  /// Bytes that have come; each frame that it answers.
  [[nodiscard]] virtual std::vector<std::string> receive(std::string_view bytes, EmulatedMotor& motor) = 0;
  /// Its watchdog looks; or would, if it were enabled.
  virtual void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) = 0;
  /// Something is wrong with the motor: it lets go, and says so where it says anything.
  virtual void fail(EmulatedMotor& motor) = 0;
};

}  // namespace zwidth::test
