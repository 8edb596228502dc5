#include "rig/moteus_protocol.hpp"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <limits>
#include <span>

namespace zwidth::rig {
namespace {

constexpr unsigned polynomial = 0x97;
constexpr std::size_t most_bytes = 64;  // of a CAN-FD frame
constexpr double not_there = std::numeric_limits<double>::quiet_NaN();

// Registers, docs/protocol/registers.md:
constexpr unsigned mode_register = 0x00;
constexpr unsigned position_register = 0x01;
constexpr unsigned fault_register = 0x0f;
constexpr unsigned version_register = 0x101;

unsigned crc_of(std::string_view text) noexcept {
  unsigned crc = 0;
  for (const char c : text) {
    crc ^= static_cast<unsigned char>(c);
    for (int bit = 0; bit < 8; ++bit) crc = ((crc << 1U) ^ ((crc & 0x80U) != 0 ? polynomial : 0U)) & 0xffU;
  }
  return crc;
}

void add_hex(SerialFrame& frame, double value) noexcept {
  const auto bits = std::bit_cast<std::uint32_t>(static_cast<float>(value));
  for (unsigned shift = 0; shift < 32; shift += 8) frame.print("{:02x}", (bits >> shift) & 0xffU);
}

/// The bytes of a reply, read one value after the other.
class Reader {
 public:
  explicit Reader(std::span<const unsigned char> bytes) : rest_(bytes) {}
  [[nodiscard]] bool is_empty() const noexcept { return rest_.empty(); }
  /// Little-endian, sign-extended; nothing where it ends too early.
  [[nodiscard]] std::optional<std::uint32_t> take(std::size_t size) noexcept {
    if (rest_.size() < size) return std::nullopt;
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::uint32_t>(rest_[i]) << (8 * i);
    rest_ = rest_.subspan(size);
    return value;
  }

  /// Seven bits a byte, the lowest first: the number of a register has one byte or two.
  [[nodiscard]] std::optional<std::uint32_t> take_varuint() noexcept {
    constexpr std::uint32_t more = 0x80;
    const auto low = take(1);
    if (!low || *low < more) return low;
    const auto high = take(1);
    if (!high || *high >= more) return std::nullopt;
    return (*low & ~more) | *high << 7U;
  }

 private:
  std::span<const unsigned char> rest_;
};

enum class Type { int8, int16, int32, real };
constexpr std::array<std::size_t, 4> sizes{1, 2, 4, 4};
constexpr std::array<double, 3> turns_per_step{0.01, 0.0001, 0.00001};

/// An integer as it stands, or a float; the most negative integer says that there is none.
double value_of(std::uint32_t bits, Type type) noexcept {
  const auto integer = [](auto value) {
    return value == std::numeric_limits<decltype(value)>::min() ? not_there : static_cast<double>(value);
  };
  switch (type) {
    case Type::int8:
      return integer(static_cast<std::int8_t>(bits));
    case Type::int16:
      return integer(static_cast<std::int16_t>(bits));
    case Type::int32:
      return integer(static_cast<std::int32_t>(bits));
    default:
      return static_cast<double>(std::bit_cast<float>(bits));
  }
}

void keep(MoteusReply& reply, unsigned which, double value, Type type) noexcept {
  constexpr double largest = 0xffffff;
  const auto whole = [&] { return value >= -largest && value <= largest ? static_cast<int>(value) : -1; };
  if (which == mode_register) reply.mode = whole();
  if (which == fault_register) reply.fault = whole();
  if (which == version_register) reply.firmware = whole();
  if (which == position_register) {
    reply.position = type == Type::real ? value : value * turns_per_step.at(static_cast<std::size_t>(type));
  }
}

std::optional<MoteusReply> decoded(Reader bytes) noexcept {
  constexpr unsigned nop = 0x50;
  constexpr unsigned reply_kind = 0x20;
  MoteusReply reply;
  while (!bytes.is_empty()) {
    const unsigned kind = *bytes.take(1);
    if (kind == nop) continue;
    if ((kind & 0xf0U) != reply_kind) return std::nullopt;
    const auto type = static_cast<Type>((kind >> 2U) & 3U);
    auto count = (kind & 3U) != 0 ? std::optional<std::uint32_t>(kind & 3U) : bytes.take(1);
    const auto first = bytes.take_varuint();
    if (!count || !first) return std::nullopt;
    for (std::uint32_t i = 0; i < *count; ++i) {
      const auto bits = bytes.take(sizes.at(static_cast<std::size_t>(type)));
      if (!bits) return std::nullopt;
      keep(reply, *first + i, value_of(*bits, type), type);
    }
  }
  return reply;
}

std::optional<unsigned> as_hex(std::string_view text) noexcept {
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// The first word, which is taken off.
std::string_view word(std::string_view& text) noexcept {
  const std::string_view first = text.substr(0, text.find(' '));
  text.remove_prefix(std::min(text.size(), first.size() + 1));
  return first;
}

struct Data {
  std::array<unsigned char, most_bytes> bytes{};
  std::size_t count = 0;
  [[nodiscard]] std::span<const unsigned char> view() const noexcept { return std::span(bytes).first(count); }
};

/// Of a frame that the drive of that id sent.
std::optional<Data> data_from(std::string_view answer, int id) noexcept {
  if (word(answer) != "rcv") return std::nullopt;
  const auto from = as_hex(word(answer));
  if (!from || ((*from >> 8U) & 0x7fU) != static_cast<unsigned>(id)) return std::nullopt;
  const std::string_view digits = word(answer);
  if (digits.empty() || digits.size() % 2 != 0 || digits.size() > 2 * most_bytes) return std::nullopt;
  Data data;
  data.count = digits.size() / 2;
  for (std::size_t i = 0; i < data.count; ++i) {
    const auto byte = as_hex(digits.substr(2 * i, 2));
    if (!byte) return std::nullopt;
    data.bytes.at(i) = static_cast<unsigned char>(*byte);
  }
  return data;
}

}  // namespace

SerialFrame moteus_line(std::string_view text, bool has_checksum) noexcept {
  SerialFrame frame;
  frame.add(text);
  if (has_checksum) {
    frame.add(" ");
    frame.print("*{:02X}", crc_of(frame.view()));
  }
  frame.add("\n");
  return frame;
}

std::optional<std::string_view> moteus_answer(std::string_view line, bool needs_checksum) noexcept {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  const std::size_t star = line.rfind('*');
  if (star == std::string_view::npos || star + 3 != line.size()) {
    if (needs_checksum) return std::nullopt;
    return line;
  }
  const auto stated = as_hex(line.substr(star + 1));
  line = line.substr(0, star);
  if (!stated || *stated != crc_of(line)) return std::nullopt;
  while (!line.empty() && line.back() == ' ') line.remove_suffix(1);
  return line;
}

SerialFrame moteus_question(int id) noexcept {
  SerialFrame frame;
  frame.print("can send 80{:02x} 11001d01", id);
  return frame;
}

SerialFrame moteus_mark(int id) noexcept {
  SerialFrame frame;
  frame.print("can send 80{:02x} 11{:02x}", id, fault_register);
  return frame;
}

SerialFrame moteus_version_question(int id) noexcept {
  SerialFrame frame;
  frame.print("can send 80{:02x} 19{:02x}{:02x}", id, (version_register & 0x7fU) | 0x80U, version_register >> 7U);
  return frame;
}

SerialFrame moteus_torque(int id, double torque, double watchdog) noexcept {
  SerialFrame frame;
  frame.print("can send 00{:02x} 01000a0d22", id);
  add_hex(frame, torque);
  frame.add("022300000d27");  // no share of kp and kd; the watchdog
  add_hex(frame, watchdog);
  return frame;
}

SerialFrame moteus_damped_torque(int id, double torque, std::optional<double> limit, double watchdog) noexcept {
  SerialFrame frame;
  frame.print("can send 00{:02x} 01000a0e20", id);
  add_hex(frame, not_there);
  add_hex(frame, 0.0);
  frame.add("0d22");
  add_hex(frame, torque);
  frame.add("02237f7f");  // the whole of kp and kd
  if (limit) {
    frame.add("0d25");
    add_hex(frame, *limit);
  }
  frame.add("0d27");
  add_hex(frame, watchdog);
  return frame;
}

SerialFrame moteus_tunnel(int id, std::string_view text) noexcept {
  SerialFrame frame;
  frame.print("can send 00{:02x} 4001{:02x}", id, text.size());
  for (const char c : text) frame.print("{:02x}", static_cast<unsigned char>(c));
  return frame;
}

SerialFrame moteus_tunnel_question(int id) noexcept {
  SerialFrame frame;
  frame.print("can send 80{:02x} 420130", id);
  return frame;
}

SerialFrame moteus_stop(int id) noexcept {
  SerialFrame frame;
  frame.print("can send 00{:02x} 010000", id);
  return frame;
}

std::optional<MoteusReply> moteus_reply(std::string_view answer, int id) noexcept {
  const auto data = data_from(answer, id);
  return data ? decoded(Reader(data->view())) : std::nullopt;
}

std::optional<std::string> moteus_tunnel_reply(std::string_view answer, int id) {
  constexpr unsigned char server_to_client = 0x41;
  constexpr std::size_t head = 3;  // kind, channel, size
  const auto data = data_from(answer, id);
  if (!data || data->count < head || data->bytes[0] != server_to_client) return std::nullopt;
  const std::size_t size = data->bytes[2];
  if (size == 0 || size > data->count - head) return std::nullopt;
  std::string text(data->bytes.begin() + head, data->bytes.begin() + static_cast<std::ptrdiff_t>(head + size));
  while (!text.empty() && (text.back() == '\n' || text.back() == '\r')) text.pop_back();
  return text.empty() ? std::nullopt : std::optional(std::move(text));
}

}  // namespace zwidth::rig
