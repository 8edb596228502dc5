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

/// Of the firmware, in COMM_FW_VERSION.
struct VescVersion {
  int major = 0;
  int minor = 0;
};

/// What a motor's settings say, of COMM_GET_MCCONF.
struct VescSettings {
  double least_current = 0.0;   ///< A, of which it makes none (l_cc_min_current)
  double angle_division = 1.0;  ///< its position is the motor's divided by that (p_pid_ang_div)
};

inline constexpr std::size_t vesc_short_payload = 255;  ///< bytes, of a packet that begins with 02
inline constexpr std::size_t vesc_long_payload = 512;   ///< of one that begins with 03: more than the settings have

/// 02, length, payload, CRC-16 (polynomial 0x1021, start 0) high and low, 03. Requires 1 to 100 bytes of payload.
[[nodiscard]] SerialFrame vesc_packet(std::string_view payload) noexcept;
/// The same with a CRC that came with the payload, right or wrong.
[[nodiscard]] SerialFrame vesc_packet(std::string_view payload, unsigned crc) noexcept;
/// How many bytes the first packet of so many bytes of payload at most has; 1 where none begins there; 0 where more bytes must
/// tell. Above vesc_short_payload the end of a packet that is torn looks like the begin of one with some 500 bytes.
[[nodiscard]] std::size_t vesc_packet_size(std::string_view bytes, std::size_t most = vesc_short_payload) noexcept;
/// The payload of a whole packet; nothing where its CRC or its end is wrong.
[[nodiscard]] std::optional<std::string_view> vesc_payload(std::string_view packet) noexcept;

/// SET_CURRENT, in whole mA.
[[nodiscard]] SerialFrame vesc_current(double amperes) noexcept;
/// GET_VALUES_SELECTIVE of fault, position and status.
[[nodiscard]] SerialFrame vesc_question() noexcept;
/// The same of the status alone, whose answer is no other's.
[[nodiscard]] SerialFrame vesc_mark() noexcept;
/// FW_VERSION and GET_MCCONF.
[[nodiscard]] SerialFrame vesc_version_question() noexcept;
[[nodiscard]] SerialFrame vesc_settings_question() noexcept;
/// Its answer; nothing for any other payload.
[[nodiscard]] std::optional<VescVersion> vesc_version(std::string_view payload) noexcept;
/// Whether the payload has settings, known or not.
[[nodiscard]] bool has_vesc_settings(std::string_view payload) noexcept;
/// They themselves, where their signature is that of firmware 6.00 to 7.01.
[[nodiscard]] std::optional<VescSettings> vesc_settings(std::string_view payload) noexcept;
/// The answer to a question; nothing for any other payload.
[[nodiscard]] std::optional<VescValues> vesc_values(std::string_view payload) noexcept;
/// Whether the payload answers vesc_mark().
[[nodiscard]] bool is_vesc_mark(std::string_view payload) noexcept;

}  // namespace zwidth::rig
