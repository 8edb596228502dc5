#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

namespace zwidth::rig {

/// A few bytes for a serial line, put together without allocation. What does not fit is left out.
class SerialFrame {
 public:
  void add(std::string_view bytes) noexcept {
    const std::size_t size = std::min(bytes.size(), bytes_.size() - size_);
    std::copy_n(bytes.begin(), size, bytes_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += size;
  }
  void add_byte(unsigned byte) noexcept {
    const char character = static_cast<char>(byte & 0xffU);
    add({&character, 1});
  }
  template <typename... Values>
  void print(fmt::format_string<Values...> format, Values&&... values) noexcept {
    const std::size_t room = bytes_.size() - size_;
    const auto printed = fmt::format_to_n(bytes_.data() + size_, room, format, std::forward<Values>(values)...);
    size_ += std::min(room, printed.size);
  }
  [[nodiscard]] std::string_view view() const noexcept { return {bytes_.data(), size_}; }

 private:
  std::array<char, 520> bytes_{};  // the settings of a VESC
  std::size_t size_ = 0;
};

/// The number that the whole text is: as %f of C prints it, "nan" too.
[[nodiscard]] inline std::optional<double> as_number(std::string_view text) noexcept {
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return number;
}

}  // namespace zwidth::rig
