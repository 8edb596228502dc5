#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "rig/serial_frame.hpp"

namespace zwidth::rig {

/// What a microcontroller with firmware/zwidth_serial.h is told: the first byte of a frame (docs/rig_serial.md).
enum class MicrocontrollerCommand : unsigned char {
  question = 'q',    ///< position, please
  force = 'f',       ///< this force from now on; the one that has no answer
  hold = 'h',        ///< take forces from now on, zero at first
  release = 'r',     ///< zero force, for good
  description = 'd'  ///< what are you?
};

/// Who has the device's force.
struct MicrocontrollerState {
  static constexpr unsigned alone = 0;    ///< no host has held it since it started
  static constexpr unsigned holding = 1;  ///< the host
  static constexpr unsigned let_go = 2;   ///< nobody: its watchdog bit
  static constexpr unsigned released = 3;
  static constexpr unsigned first_fault = 16;
};

/// What answers everything but a force and a description.
struct MicrocontrollerAnswer {
  std::uint16_t sequence = 0;  ///< of the frame that it answers
  unsigned state = MicrocontrollerState::alone;
  double position = 0.0;  ///< m or rad
  double velocity = 0.0;  ///< m/s or rad/s; 0 where it is not known
  double force = 0.0;     ///< N or N m, applied
};

struct MicrocontrollerDescription {
  std::uint16_t sequence = 0;
  unsigned state = MicrocontrollerState::alone;
  unsigned version = 0;       ///< of the protocol
  double watchdog = 0.0;      ///< s
  unsigned times_let_go = 0;  ///< modulo 2^16
  double silence = 0.0;       ///< s, from the last force to when it let go, of the last time
  double force_limit = 0.0;   ///< N or N m
};

inline constexpr std::size_t microcontroller_question_bytes = 7;
inline constexpr std::size_t microcontroller_force_bytes = 11;
inline constexpr std::size_t microcontroller_answer_bytes = 20;

/// A frame of any command but a force.
[[nodiscard]] SerialFrame microcontroller_frame(MicrocontrollerCommand command, std::uint16_t sequence) noexcept;
/// N or N m.
[[nodiscard]] SerialFrame microcontroller_force(double force, std::uint16_t sequence) noexcept;

/// Nothing for any other bytes than those of an answer, its end included.
[[nodiscard]] std::optional<MicrocontrollerAnswer> microcontroller_answer(std::string_view frame) noexcept;
[[nodiscard]] std::optional<MicrocontrollerDescription> microcontroller_description(std::string_view frame) noexcept;

}  // namespace zwidth::rig
