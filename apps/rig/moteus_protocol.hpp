#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "rig/serial_frame.hpp"

namespace zwidth::rig {

/// Registers that a reply of moteus held; the rest are skipped.
struct MoteusReply {
  std::optional<int>
      mode;  ///< 0: stopped, 1: fault, 10: position, 11: its watchdog has let go, 12: zero velocity, 15: brake
  std::optional<double> position;  ///< turns of the output
  std::optional<int> fault;
  std::optional<int> firmware;  ///< version: major, minor and micro, a byte each
};

/// A line with its end; with a checksum " *XX", the CRC-8 (polynomial 0x97, start 0) of all that stands before the star.
[[nodiscard]] SerialFrame moteus_line(std::string_view text, bool has_checksum) noexcept;
/// What stands in a line before its checksum; nothing where that is wrong, or is missing though it is required.
[[nodiscard]] std::optional<std::string_view> moteus_answer(std::string_view line, bool needs_checksum) noexcept;

/// `can send` of a question for mode and position, as int8 and float.
[[nodiscard]] SerialFrame moteus_question(int id) noexcept;
/// The same of the fault alone, which no other question asks for.
[[nodiscard]] SerialFrame moteus_mark(int id) noexcept;
/// The same of the firmware's version, as int32.
[[nodiscard]] SerialFrame moteus_version_question(int id) noexcept;
/// The same of position mode without gains: the torque alone, N m at the output, for as long as the watchdog, s.
[[nodiscard]] SerialFrame moteus_torque(int id, double torque, double watchdog) noexcept;
/// The same beside the drive's own damper: at no position and velocity 0, both gains whole, of which that of position is 0;
/// torque and damper together within `limit`, N m, where one is given.
[[nodiscard]] SerialFrame moteus_damped_torque(int id, double torque, std::optional<double> limit,
                                               double watchdog) noexcept;
/// The same of a text for the drive's diagnostic stream, "conf get id.id\n", of at most 48 characters; and of the question
/// for what that says.
[[nodiscard]] SerialFrame moteus_tunnel(int id, std::string_view text) noexcept;
[[nodiscard]] SerialFrame moteus_tunnel_question(int id) noexcept;
/// The same of the stopped mode, which clears faults and the watchdog's mode too.
[[nodiscard]] SerialFrame moteus_stop(int id) noexcept;

/// `rcv`: what the drive of that id replies; nothing for any other text, a reply of another drive, or a frame that is not
/// whole. Flags after the data, as of fdcanusb, are passed over.
[[nodiscard]] std::optional<MoteusReply> moteus_reply(std::string_view answer, int id) noexcept;
/// What its diagnostic stream says, without the end of the line; nothing for any other text, and where it says nothing.
[[nodiscard]] std::optional<std::string> moteus_tunnel_reply(std::string_view answer, int id);

}  // namespace zwidth::rig
