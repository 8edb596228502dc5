#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace zwidth::cli {

inline constexpr double largest_number = 1e30;  // of a quantity in SI units: squares of it are still numbers

/// The whole text as a number of at most `largest_number` in magnitude, or nothing.
[[nodiscard]] inline std::optional<double> number_in(std::string_view text) {
  double value = 0.0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc() || end != text.data() + text.size() || !(std::abs(value) <= largest_number)) {
    return std::nullopt;
  }
  return value;
}

/// What stands between the separators: one part more than there are of them.
[[nodiscard]] inline std::vector<std::string> parts_of(std::string_view text, char separator) {
  std::vector<std::string> parts(1);
  for (const char letter : text) {
    letter == separator ? (void)parts.emplace_back() : parts.back().push_back(letter);
  }
  return parts;
}

}  // namespace zwidth::cli
