#include "io/prose.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace zwidth::internal {
namespace {

constexpr std::size_t longest_shown = 60;
constexpr std::size_t most_listed = 12;

/// Bytes of the control character that UTF-8 text begins with; 0 where it begins with none.
std::size_t control_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0xFFU; };
  const auto between = [](unsigned value, unsigned low, unsigned high) { return value >= low && value <= high; };
  if (byte(0) < 0x20 || byte(0) == 0x7F) return 1;
  if (byte(0) == 0xC2 && between(byte(1), 0x80, 0x9F)) return 2;
  if (byte(0) != 0xE2) return 0;
  const bool turns_direction = (byte(1) == 0x80 && between(byte(2), 0xAA, 0xAE)) ||  // U+202A to U+202E
                               (byte(1) == 0x81 && between(byte(2), 0xA6, 0xA9));    // U+2066 to U+2069
  return turns_direction ? 3 : 0;
}

}  // namespace

std::string shortened(std::string_view text) {
  if (text.size() <= longest_shown) return std::string(text);
  std::size_t end = longest_shown;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not inside a UTF-8 character
  return fmt::format("{}...", text.substr(0, end));
}

bool has_controls(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (control_length(text.substr(i)) > 0) return true;
  }
  return false;
}

std::string without_controls(std::string_view text) {
  std::string plain;
  while (!text.empty()) {
    const std::size_t control = control_length(text);
    for (const char byte : text.substr(0, control)) {
      plain += fmt::format("\\x{:02X}", static_cast<unsigned char>(byte));
    }
    if (control == 0) plain += text.front();
    text.remove_prefix(std::max<std::size_t>(1, control));
  }
  return plain;
}

std::string listed(std::span<const std::string> words) {
  const auto shown = words.first(std::min(words.size(), most_listed));
  return fmt::format("{}{}", fmt::join(shown, ", "), shown.size() < words.size() ? ", ..." : "");
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return lower;
}

}  // namespace zwidth::internal
