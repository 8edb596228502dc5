#include "io/prose.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace zwidth {
namespace {

constexpr std::size_t longest_shown = 60;
constexpr std::size_t most_listed = 12;

}  // namespace

std::string shortened(std::string_view text) {
  if (text.size() <= longest_shown) return std::string(text);
  std::size_t end = longest_shown;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;  // not inside a UTF-8 character
  return fmt::format("{}...", text.substr(0, end));
}

std::string in_quotes(std::string_view text) { return fmt::format("\"{}\"", shortened(text)); }

std::string listed(std::span<const std::string> words) {
  const auto shown = words.first(std::min(words.size(), most_listed));
  return fmt::format("{}{}", fmt::join(shown, ", "), shown.size() < words.size() ? ", ..." : "");
}

}  // namespace zwidth
