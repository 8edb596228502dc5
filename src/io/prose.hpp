#pragma once

#include <span>
#include <string>
#include <string_view>

namespace zwidth::internal {

/// `text` cut to what fits in a message.
[[nodiscard]] std::string shortened(std::string_view text);

/// `words` as a list in prose: a, b, c.
[[nodiscard]] std::string listed(std::span<const std::string> words);

/// ASCII letters in lower case, all else as it is.
[[nodiscard]] std::string lower_case(std::string_view text);

/// Whether UTF-8 text has a control character: U+0000 to U+001F, U+007F to U+009F, or one that turns the direction of
/// what follows (U+202A to U+202E, U+2066 to U+2069), which would make a name read as another.
[[nodiscard]] bool has_controls(std::string_view text);

/// The text with the bytes of its control characters as \xHH.
[[nodiscard]] std::string without_controls(std::string_view text);

}  // namespace zwidth::internal
