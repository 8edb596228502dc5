#include "rig/vesc_protocol.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <boost/crc.hpp>
#include <cmath>
#include <cstdint>

namespace zwidth::rig {
namespace {

constexpr unsigned char start = 2;
constexpr unsigned char long_start = 3;  // a length of two bytes
constexpr unsigned char end = 3;
constexpr std::size_t frame_bytes = 5;  // around the payload

// datatypes.h:
constexpr unsigned firmware_version = 0;
constexpr unsigned set_current = 6;
constexpr unsigned get_settings = 14;
constexpr unsigned get_values_selective = 50;
// commands.c: which fields
constexpr unsigned fault_bit = 15;
constexpr unsigned position_bit = 16;
constexpr unsigned status_bit = 21;
constexpr std::uint32_t mask = 1U << fault_bit | 1U << position_bit | 1U << status_bit;
constexpr std::uint32_t mark_mask = 1U << status_bit;
constexpr double steps_per_turn = 360e6;  // millionths of a degree

// confgenerator.c, whose MCCONF_SIGNATURE tells its order of the settings: where these two stand behind the command.
struct SettingsLayout {
  std::uint32_t signature;
  std::size_t angle_division;
  std::size_t least_current;
};
constexpr std::array<SettingsLayout, 5> layouts{{{776184161, 371, 383},     // 6.00, 6.02
                                                 {1065524471, 361, 373},    // 6.05
                                                 {788332866, 367, 379},     // 6.06
                                                 {1470992211, 372, 384},    // 7.00
                                                 {2466726157, 372, 384}}};  // 7.01
constexpr double undivided = 0.02;                                          // of 1: what the firmware takes for 1

unsigned byte_at(std::string_view bytes, std::size_t at) noexcept { return static_cast<unsigned char>(bytes[at]); }

/// Its first byte, and how many tell the length.
std::size_t length_bytes(std::string_view packet) noexcept { return byte_at(packet, 0) == long_start ? 2 : 1; }

std::size_t stated_length(std::string_view packet) noexcept {
  return length_bytes(packet) == 2 ? byte_at(packet, 1) << 8U | byte_at(packet, 2) : byte_at(packet, 1);
}

std::uint32_t big_endian(std::string_view bytes) noexcept {
  return byte_at(bytes, 0) << 24U | byte_at(bytes, 1) << 16U | byte_at(bytes, 2) << 8U | byte_at(bytes, 3);
}

void add_big_endian(SerialFrame& frame, std::uint32_t value) noexcept {
  for (int shift = 24; shift >= 0; shift -= 8) frame.add_byte(value >> static_cast<unsigned>(shift));
}

unsigned crc_of(std::string_view payload) noexcept {
  boost::crc_optimal<16, 0x1021, 0, 0, false, false> crc;
  crc.process_bytes(payload.data(), payload.size());
  return crc.checksum();
}

SerialFrame selective(std::uint32_t fields) noexcept {
  SerialFrame payload;
  payload.add_byte(get_values_selective);
  add_big_endian(payload, fields);
  return vesc_packet(payload.view());
}

bool has_fields(std::string_view payload, std::size_t size, std::uint32_t fields) noexcept {
  return payload.size() == size && byte_at(payload, 0) == get_values_selective &&
         big_endian(payload.substr(1)) == fields;
}

}  // namespace

SerialFrame vesc_packet(std::string_view payload) noexcept { return vesc_packet(payload, crc_of(payload)); }

SerialFrame vesc_packet(std::string_view payload, unsigned crc) noexcept {
  SerialFrame frame;
  const auto size = static_cast<unsigned>(payload.size());
  frame.add_byte(size > vesc_short_payload ? long_start : start);
  if (size > vesc_short_payload) frame.add_byte(size >> 8U);
  frame.add_byte(size);
  frame.add(payload);
  frame.add_byte(crc >> 8U);
  frame.add_byte(crc);
  frame.add_byte(end);
  return frame;
}

std::size_t vesc_packet_size(std::string_view bytes, std::size_t most) noexcept {
  if (bytes.empty()) return 0;
  const bool is_long = byte_at(bytes, 0) == long_start && most > vesc_short_payload;
  if (byte_at(bytes, 0) != start && !is_long) return 1;
  const std::size_t more = length_bytes(bytes) - 1;
  if (bytes.size() < 2 + more) return 0;
  const std::size_t length = stated_length(bytes);
  if (length == 0 || length > most || (is_long && length <= vesc_short_payload)) return 1;
  const std::size_t size = length + frame_bytes + more;
  return bytes.size() < size ? 0 : size;
}

std::optional<std::string_view> vesc_payload(std::string_view packet) noexcept {
  if (packet.size() <= frame_bytes || byte_at(packet, packet.size() - 1) != end) return std::nullopt;
  if (byte_at(packet, 0) != start && byte_at(packet, 0) != long_start) return std::nullopt;
  const std::size_t more = length_bytes(packet) - 1;
  if (packet.size() <= frame_bytes + more) return std::nullopt;
  const std::string_view payload = packet.substr(2 + more, packet.size() - frame_bytes - more);
  if (payload.size() != stated_length(packet)) return std::nullopt;
  const unsigned stated = byte_at(packet, packet.size() - 3) << 8U | byte_at(packet, packet.size() - 2);
  if (stated != crc_of(payload)) return std::nullopt;
  return payload;
}

SerialFrame vesc_current(double amperes) noexcept {
  constexpr double most = 1e6;  // A: far beyond any drive, and in range
  SerialFrame payload;
  payload.add_byte(set_current);
  const auto milliamperes = static_cast<std::int32_t>(std::lround(1e3 * std::clamp(amperes, -most, most)));
  add_big_endian(payload, static_cast<std::uint32_t>(milliamperes));
  return vesc_packet(payload.view());
}

SerialFrame vesc_question() noexcept { return selective(mask); }

SerialFrame vesc_mark() noexcept { return selective(mark_mask); }

SerialFrame vesc_version_question() noexcept {
  constexpr char command = firmware_version;
  return vesc_packet({&command, 1});
}

SerialFrame vesc_settings_question() noexcept {
  constexpr char command = get_settings;
  return vesc_packet({&command, 1});
}

std::optional<VescVersion> vesc_version(std::string_view payload) noexcept {
  if (payload.size() < 3 || byte_at(payload, 0) != firmware_version) return std::nullopt;
  return VescVersion{static_cast<int>(byte_at(payload, 1)), static_cast<int>(byte_at(payload, 2))};
}

bool has_vesc_settings(std::string_view payload) noexcept {
  return payload.size() > 5 && byte_at(payload, 0) == get_settings;
}

std::optional<VescSettings> vesc_settings(std::string_view payload) noexcept {
  if (!has_vesc_settings(payload)) return std::nullopt;
  const std::string_view settings = payload.substr(1);
  const auto* const layout = std::ranges::find(layouts, big_endian(settings), &SettingsLayout::signature);
  if (layout == layouts.end() || settings.size() < layout->least_current + 4) return std::nullopt;
  const auto real = [&](std::size_t at) {
    return static_cast<double>(std::bit_cast<float>(big_endian(settings.substr(at))));
  };
  VescSettings found{real(layout->least_current), real(layout->angle_division)};
  if (std::abs(found.angle_division - 1.0) < undivided) found.angle_division = 1.0;
  const bool is_possible = found.least_current >= 0.0 && std::isfinite(found.least_current) &&
                           found.angle_division > 0.0 && std::isfinite(found.angle_division);
  return is_possible ? std::optional(found) : std::nullopt;
}

bool is_vesc_mark(std::string_view payload) noexcept { return has_fields(payload, 1 + 4 + 1, mark_mask); }

std::optional<VescValues> vesc_values(std::string_view payload) noexcept {
  if (!has_fields(payload, 1 + 4 + 1 + 4 + 1, mask)) return std::nullopt;
  VescValues values;
  values.fault = static_cast<int>(byte_at(payload, 5));
  values.position = static_cast<double>(static_cast<std::int32_t>(big_endian(payload.substr(6)))) / steps_per_turn;
  values.has_let_go = byte_at(payload, 10) != 0;  // its watchdog, or its kill switch
  return values;
}

}  // namespace zwidth::rig
