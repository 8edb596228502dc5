#pragma once

#include <cstdint>
#include <optional>

#include "rig/can_bus.hpp"

namespace zwidth::rig {

/// Messages of ODrive's CANSimple, 0.5 and 0.6: identifier node << 5 | command.
enum class OdriveMessage : std::uint32_t {
  version = 0x00,  ///< of 0.6 alone
  heartbeat = 0x01,
  axis_state = 0x07,
  encoder_estimates = 0x09,
  controller_mode = 0x0b,
  input_torque = 0x0e,
  bus_voltage = 0x17,
  clear_errors = 0x18
};

/// A question for that message.
[[nodiscard]] CanFrame odrive_question(int node, OdriveMessage message) noexcept;
/// The state that the axis shall go into: 1 idle, 8 closed-loop control.
[[nodiscard]] CanFrame odrive_state(int node, std::uint32_t state) noexcept;
/// Control mode 1, torque, and input mode 1, passed through as it is.
[[nodiscard]] CanFrame odrive_torque_mode(int node) noexcept;
/// N m.
[[nodiscard]] CanFrame odrive_input_torque(int node, double torque) noexcept;
[[nodiscard]] CanFrame odrive_clear_errors(int node) noexcept;

/// What message the node's frame brings; nothing where it is another's, a question, or not whole.
[[nodiscard]] std::optional<OdriveMessage> odrive_message(const CanFrame& frame, int node) noexcept;

struct OdriveHeartbeat {
  std::uint32_t error = 0;
  unsigned state = 0;
};
/// Of a frame that is a heartbeat.
[[nodiscard]] OdriveHeartbeat odrive_heartbeat(const CanFrame& frame) noexcept;
/// Turns, of one with encoder estimates.
[[nodiscard]] double odrive_position(const CanFrame& frame) noexcept;

struct OdriveVersion {
  unsigned major = 0;
  unsigned minor = 0;
};
/// The firmware's, of one with a version.
[[nodiscard]] OdriveVersion odrive_version(const CanFrame& frame) noexcept;

}  // namespace zwidth::rig
