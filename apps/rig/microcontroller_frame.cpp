#include "rig/microcontroller_frame.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <boost/crc.hpp>
#include <cmath>
#include <limits>
#include <span>

namespace zwidth::rig {
namespace {

constexpr char frame_end = '\0';
constexpr char answer_kind = 'a';
constexpr char description_kind = 'D';
constexpr std::size_t crc_bytes = 2;
// kind, sequence, state; then three floats, or version, watchdog, times let go, silence and a float
constexpr std::size_t answer_payload = 4 + 3 * 4;
constexpr std::size_t description_payload = 4 + 1 + 3 * 2 + 4;
constexpr std::size_t most_payload = answer_payload + crc_bytes;

unsigned microcontroller_crc(std::string_view bytes) noexcept {
  boost::crc_optimal<16, 0x1021, 0xffff, 0, true, true> crc;  // CRC-16/MCRF4XX
  crc.process_bytes(bytes.data(), bytes.size());
  return crc.checksum();
}

void add_little_endian(SerialFrame& frame, std::uint32_t value, unsigned bytes) noexcept {
  for (unsigned i = 0; i < bytes; ++i) frame.add_byte(value >> (8 * i));
}

std::uint32_t little_endian(std::string_view bytes, std::size_t at, std::size_t count) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = count; i > 0; --i) value = value << 8U | static_cast<unsigned char>(bytes[at + i - 1]);
  return value;
}

double single(std::string_view bytes, std::size_t at) noexcept {
  return static_cast<double>(std::bit_cast<float>(little_endian(bytes, at, 4)));
}

/// CRC, COBS (S. Cheshire, M. Baker: Consistent Overhead Byte Stuffing, 1999) and the end. At most 253 bytes.
SerialFrame encoded_for_line(SerialFrame payload) noexcept {
  add_little_endian(payload, microcontroller_crc(payload.view()), crc_bytes);
  SerialFrame frame;
  std::string_view rest = payload.view();
  for (;;) {
    const std::size_t zero = rest.find('\0');
    const std::string_view run = rest.substr(0, zero);
    frame.add_byte(static_cast<unsigned>(run.size() + 1));
    frame.add(run);
    if (zero == std::string_view::npos) break;
    rest.remove_prefix(zero + 1);
  }
  frame.add_byte(0);
  return frame;
}

/// The payload, into `to`: nothing where it is no frame of that kind and size, or its CRC is wrong.
std::optional<std::string_view> payload_of(std::string_view frame, char kind, std::size_t size,
                                           std::span<char, most_payload> to) noexcept {
  if (frame.empty() || frame.back() != frame_end) return std::nullopt;
  frame.remove_suffix(1);
  std::size_t count = 0;
  while (!frame.empty()) {
    const std::size_t code = static_cast<unsigned char>(frame.front());
    if (code == 0 || code > frame.size() || count + code > to.size() + 1) return std::nullopt;
    for (const char byte : frame.substr(1, code - 1)) to[count++] = byte;
    frame.remove_prefix(code);
    if (frame.empty()) break;
    if (count == to.size()) return std::nullopt;
    to[count++] = '\0';
  }
  const std::string_view bytes(to.data(), count);
  if (count != size + crc_bytes || bytes.front() != kind) return std::nullopt;
  if (microcontroller_crc(bytes.substr(0, size)) != little_endian(bytes, size, crc_bytes)) return std::nullopt;
  return bytes.substr(0, size);
}

SerialFrame command_payload(MicrocontrollerCommand command, std::uint16_t sequence) noexcept {
  SerialFrame payload;
  payload.add_byte(static_cast<unsigned>(command));
  add_little_endian(payload, sequence, 2);
  return payload;
}

}  // namespace

SerialFrame microcontroller_frame(MicrocontrollerCommand command, std::uint16_t sequence) noexcept {
  return encoded_for_line(command_payload(command, sequence));
}

SerialFrame microcontroller_force(double force, std::uint16_t sequence) noexcept {
  constexpr double most = std::numeric_limits<float>::max();
  constexpr float none = std::numeric_limits<float>::quiet_NaN();  // is not taken
  const float single_force = std::isfinite(force) ? static_cast<float>(std::clamp(force, -most, most)) : none;
  SerialFrame payload = command_payload(MicrocontrollerCommand::force, sequence);
  add_little_endian(payload, std::bit_cast<std::uint32_t>(single_force), 4);
  return encoded_for_line(payload);
}

std::optional<MicrocontrollerAnswer> microcontroller_answer(std::string_view frame) noexcept {
  std::array<char, most_payload> room;  // NOLINT(*-member-init): payload_of() fills what it tells of
  const auto payload = payload_of(frame, answer_kind, answer_payload, room);
  if (!payload) return std::nullopt;
  return MicrocontrollerAnswer{static_cast<std::uint16_t>(little_endian(*payload, 1, 2)), little_endian(*payload, 3, 1),
                               single(*payload, 4), single(*payload, 8), single(*payload, 12)};
}

std::optional<MicrocontrollerDescription> microcontroller_description(std::string_view frame) noexcept {
  constexpr double millisecond = 1e-3;
  std::array<char, most_payload> room;  // NOLINT(*-member-init)
  const auto payload = payload_of(frame, description_kind, description_payload, room);
  if (!payload) return std::nullopt;
  MicrocontrollerDescription found;
  found.sequence = static_cast<std::uint16_t>(little_endian(*payload, 1, 2));
  found.state = little_endian(*payload, 3, 1);
  found.version = little_endian(*payload, 4, 1);
  found.watchdog = millisecond * little_endian(*payload, 5, 2);
  found.times_let_go = little_endian(*payload, 7, 2);
  found.silence = millisecond * little_endian(*payload, 9, 2);
  found.force_limit = single(*payload, 11);
  return found;
}

}  // namespace zwidth::rig
