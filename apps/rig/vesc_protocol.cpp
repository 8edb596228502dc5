#include "rig/vesc_protocol.hpp"

#include <algorithm>
#include <boost/crc.hpp>
#include <cmath>
#include <cstdint>

namespace zwidth::rig {
namespace {

constexpr unsigned char start = 2;
constexpr unsigned char end = 3;
constexpr std::size_t frame_bytes = 5;  // around the payload

// datatypes.h:
constexpr unsigned set_current = 6;
constexpr unsigned get_values_selective = 50;
// commands.c: which fields
constexpr unsigned fault_bit = 15;
constexpr unsigned position_bit = 16;
constexpr unsigned status_bit = 21;
constexpr std::uint32_t mask = 1U << fault_bit | 1U << position_bit | 1U << status_bit;
constexpr std::uint32_t mark_mask = 1U << status_bit;
constexpr double steps_per_turn = 360e6;  // millionths of a degree

unsigned byte_at(std::string_view bytes, std::size_t at) noexcept { return static_cast<unsigned char>(bytes[at]); }

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
  frame.add_byte(start);
  frame.add_byte(static_cast<unsigned>(payload.size()));
  frame.add(payload);
  frame.add_byte(crc >> 8U);
  frame.add_byte(crc);
  frame.add_byte(end);
  return frame;
}

std::size_t vesc_packet_size(std::string_view bytes) noexcept {
  if (bytes.empty()) return 0;
  if (byte_at(bytes, 0) != start) return 1;
  if (bytes.size() < 2) return 0;
  const std::size_t length = byte_at(bytes, 1);
  if (length == 0) return 1;
  return bytes.size() < length + frame_bytes ? 0 : length + frame_bytes;
}

std::optional<std::string_view> vesc_payload(std::string_view packet) noexcept {
  if (packet.size() <= frame_bytes || byte_at(packet, 0) != start || byte_at(packet, packet.size() - 1) != end) {
    return std::nullopt;
  }
  const std::string_view payload = packet.substr(2, packet.size() - frame_bytes);
  if (payload.size() != byte_at(packet, 1)) return std::nullopt;
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
