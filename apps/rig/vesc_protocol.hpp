#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "rig/serial_frame.hpp"

namespace zwidth::rig {

/// What a VESC says of itself, of COMM_GET_VALUES_SELECTIVE with the three fields that vesc_question() asks for.
struct VescValues {
  int fault = 0;          ///< 0: none
  double position = 0.0;  ///< of the motor, turns, 0 to 1
  bool has_let_go = false;
};

/// 02, length, payload, CRC-16 (polynomial 0x1021, start 0) high and low, 03. Requires 1 to 100 bytes of payload.
[[nodiscard]] SerialFrame vesc_packet(std::string_view payload) noexcept;
/// The same with a CRC that came with the payload, right or wrong.
[[nodiscard]] SerialFrame vesc_packet(std::string_view payload, unsigned crc) noexcept;
/// How many bytes the first packet has; 1 where none begins there; 0 where more bytes must tell.
[[nodiscard]] std::size_t vesc_packet_size(std::string_view bytes) noexcept;
/// The payload of a whole packet of at most 255 bytes; nothing where its CRC or its end is wrong.
[[nodiscard]] std::optional<std::string_view> vesc_payload(std::string_view packet) noexcept;

/// SET_CURRENT, in whole mA.
[[nodiscard]] SerialFrame vesc_current(double amperes) noexcept;
/// GET_VALUES_SELECTIVE of fault, position and status.
[[nodiscard]] SerialFrame vesc_question() noexcept;
/// The same of the status alone, whose answer is no other's.
[[nodiscard]] SerialFrame vesc_mark() noexcept;
/// The answer to a question; nothing for any other payload.
[[nodiscard]] std::optional<VescValues> vesc_values(std::string_view payload) noexcept;
/// Whether the payload answers vesc_mark().
[[nodiscard]] bool is_vesc_mark(std::string_view payload) noexcept;

}  // namespace zwidth::rig
