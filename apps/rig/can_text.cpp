#include "rig/can_text.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>

namespace zwidth::rig {
namespace {

// Of the length's code: 0 to 8 as they are.
constexpr std::array<std::size_t, 16> sizes{0, 1, 2, 3, 4, 5, 6, 7, 8, 12, 16, 20, 24, 32, 48, 64};
constexpr std::size_t most_classic = 8;
constexpr std::uint32_t largest_standard = 0x7ff;
constexpr std::uint32_t largest_extended = 0x1fffffff;
constexpr unsigned char padding = 0x50;  // which a moteus passes over, as its fdcanusb has it

std::optional<std::uint32_t> number_in_hex(std::string_view text) noexcept {
  std::uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// Without its end.
std::string_view without_end(std::string_view line) noexcept {
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
  return line;
}

/// The first word, which is taken off.
std::string_view next_word(std::string_view& text) noexcept {
  const std::string_view first = text.substr(0, text.find(' '));
  text.remove_prefix(std::min(text.size(), first.size() + 1));
  return first;
}

bool read_data(std::string_view digits, CanFrame& frame) noexcept {
  if (digits.size() % 2 != 0 || digits.size() > 2 * CanFrame::most_bytes) return false;
  frame.size = digits.size() / 2;
  for (std::size_t i = 0; i < frame.size; ++i) {
    const auto byte = number_in_hex(digits.substr(2 * i, 2));
    if (!byte) return false;
    frame.bytes.at(i) = static_cast<unsigned char>(*byte);
  }
  return true;
}

void print_data(const CanFrame& frame, std::size_t size, SerialFrame& text) noexcept {
  for (std::size_t i = 0; i < size; ++i) {
    text.print("{:02X}", static_cast<unsigned>(i < frame.size ? frame.bytes.at(i) : padding));
  }
}

bool is_possible(const CanFrame& frame) noexcept {
  if (frame.id > (frame.is_extended ? largest_extended : largest_standard)) return false;
  return frame.is_fd ? !frame.is_remote && can_fd_size(frame.size) == frame.size : frame.size <= most_classic;
}

void print_id(const CanFrame& frame, SerialFrame& text) noexcept {
  if (frame.is_extended) {
    text.print("{:08X}", frame.id);
  } else {
    text.print("{:03X}", frame.id);
  }
}

}  // namespace

std::optional<std::size_t> can_fd_size(std::size_t bytes) noexcept {
  const auto* const found = std::ranges::lower_bound(sizes, bytes);
  return found == sizes.end() ? std::nullopt : std::optional(*found);
}

SerialFrame slcan_line(const CanFrame& frame) noexcept {
  SerialFrame line;
  const char kind = frame.is_remote ? 'r' : frame.is_fd ? 'b' : 't';
  line.add_byte(static_cast<unsigned>(frame.is_extended ? kind - 'a' + 'A' : kind));
  print_id(frame, line);
  const std::size_t size = can_fd_size(frame.size).value_or(frame.size);
  line.print("{:X}", std::ranges::lower_bound(sizes, size) - sizes.begin());
  if (!frame.is_remote) print_data(frame, size, line);
  line.add("\r");
  return line;
}

std::optional<CanFrame> slcan_frame(std::string_view line) noexcept {
  line = without_end(line);
  constexpr std::string_view kinds = "tTrRdDbB";
  if (line.empty() || kinds.find(line.front()) == std::string_view::npos) return std::nullopt;
  const char kind = line.front();
  CanFrame frame;
  frame.is_extended = kind >= 'A' && kind <= 'Z';
  frame.is_remote = kind == 'r' || kind == 'R';
  frame.is_fd = kind == 'd' || kind == 'D' || kind == 'b' || kind == 'B';
  const std::size_t id_digits = frame.is_extended ? 8 : 3;
  if (line.size() < 1 + id_digits + 1) return std::nullopt;
  const auto id = number_in_hex(line.substr(1, id_digits));
  const auto code = number_in_hex(line.substr(1 + id_digits, 1));
  if (!id || !code) return std::nullopt;
  frame.id = *id;
  const std::size_t size = sizes.at(*code);
  const std::string_view digits = line.substr(1 + id_digits + 1);
  if (digits.size() != (frame.is_remote ? 0 : 2 * size) || !read_data(digits, frame)) return std::nullopt;
  frame.size = size;
  return is_possible(frame) ? std::optional(frame) : std::nullopt;
}

SerialFrame fdcanusb_line(const CanFrame& frame) noexcept {
  SerialFrame line;
  line.add(frame.is_extended ? "can ext " : "can std ");
  print_id(frame, line);
  line.add(" ");
  print_data(frame, frame.size, line);
  if (!frame.is_fd) line.add(frame.is_remote ? " bfR" : " bfr");
  line.add("\n");
  return line;
}

std::optional<CanFrame> fdcanusb_order(std::string_view line) noexcept {
  line = without_end(line);
  if (next_word(line) != "can") return std::nullopt;
  const std::string_view kind = next_word(line);
  if (kind != "send" && kind != "std" && kind != "ext") return std::nullopt;
  const auto id = number_in_hex(next_word(line));
  CanFrame frame;
  if (!id || !read_data(next_word(line), frame) || frame.size == 0) return std::nullopt;
  frame.id = *id;
  frame.is_extended = kind == "ext" || (kind == "send" && *id > largest_standard);
  frame.is_fd = line.find('f') == std::string_view::npos;
  frame.is_remote = line.find('R') != std::string_view::npos;
  if (frame.is_fd) {
    const auto size = can_fd_size(frame.size);
    if (!size) return std::nullopt;
    std::fill(frame.bytes.begin() + static_cast<std::ptrdiff_t>(frame.size),
              frame.bytes.begin() + static_cast<std::ptrdiff_t>(*size), padding);
    frame.size = *size;
  }
  return is_possible(frame) ? std::optional(frame) : std::nullopt;
}

SerialFrame fdcanusb_report(const CanFrame& frame) noexcept {
  SerialFrame line;
  line.add("rcv ");
  print_id(frame, line);
  line.add(" ");
  print_data(frame, frame.data().size(), line);
  line.print(" {} {} {} {}\n", frame.is_extended ? 'E' : 'e', frame.is_fd ? 'B' : 'b', frame.is_fd ? 'F' : 'f',
             frame.is_remote ? 'R' : 'r');
  return line;
}

std::optional<CanFrame> fdcanusb_frame(std::string_view line) noexcept {
  line = without_end(line);
  if (next_word(line) != "rcv") return std::nullopt;
  const auto id = number_in_hex(next_word(line));
  CanFrame frame;
  if (!id || !read_data(next_word(line), frame)) return std::nullopt;
  frame.id = *id;
  frame.is_fd = true;  // an fdcanusb says all of them; what is not said is that of a moteus
  frame.is_extended = *id > largest_standard;
  while (!line.empty()) {
    const std::string_view flag = next_word(line);
    if (flag == "E" || flag == "e") frame.is_extended = flag == "E";
    if (flag == "F" || flag == "f") frame.is_fd = flag == "F";
    if (flag == "R" || flag == "r") frame.is_remote = flag == "R";
  }
  return is_possible(frame) ? std::optional(frame) : std::nullopt;
}

}  // namespace zwidth::rig
