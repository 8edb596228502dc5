#pragma once

#include <vector>

#include "rig/can_bus.hpp"
#include "rig/emulated_motor.hpp"

namespace zwidth::test {

/// A drive on a CAN bus, as its firmware's sources state it.
class CanNode {
 public:
  CanNode() = default;
  CanNode(const CanNode&) = delete;
  CanNode& operator=(const CanNode&) = delete;
  virtual ~CanNode() = default;

  /// The bus's rate, by default.
  [[nodiscard]] virtual int bitrate() const = 0;
  /// A frame on the bus; those that it answers.
  [[nodiscard]] virtual std::vector<rig::CanFrame> hear(const rig::CanFrame& frame, EmulatedMotor& motor) = 0;
  /// What it sends by itself.
  [[nodiscard]] virtual std::vector<rig::CanFrame> unasked(Clock::time_point /*now*/, EmulatedMotor& /*motor*/) {
    return {};
  }
  virtual void tick(Clock::time_point now, bool is_enabled, EmulatedMotor& motor) = 0;
  virtual void fail(EmulatedMotor& motor) = 0;
};

}  // namespace zwidth::test
