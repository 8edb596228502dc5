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
  /// Frames that nobody asked for.
  [[nodiscard]] virtual std::vector<std::string> unasked(EmulatedMotor& /*motor*/) { return {}; }
  /// s, that bytes take at the line's speed.
  [[nodiscard]] virtual double time_on_wire(std::string_view bytes, int baud) const {
    return 10.0 * static_cast<double>(bytes.size()) / baud;
  }
  /// Its watchdog looks; or would, if it were enabled.
  virtual void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) = 0;
  /// Something is wrong with the motor: it lets go, and says so where it says anything.
  virtual void fail(EmulatedMotor& motor) = 0;
};

}  // namespace zwidth::test
