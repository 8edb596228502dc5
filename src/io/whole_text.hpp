#pragma once

#include <charconv>
#include <concepts>
#include <optional>
#include <string_view>
#include <system_error>

namespace zwidth::internal {

/// The number that the whole text is: no blank, no '+'. Nothing where it is none, or out of the type's range.
template <class Number, std::same_as<int>... Base>
[[nodiscard]] std::optional<Number> whole_text_as(std::string_view text, Base... base) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base...);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

}  // namespace zwidth::internal
