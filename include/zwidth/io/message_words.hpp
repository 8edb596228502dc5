#pragma once

#include <span>
#include <string>
#include <string_view>

namespace zwidth {

/// The candidate that `word` probably misspells, or an empty string: at most one edit per three letters.
[[nodiscard]] std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

/// `text` in double quotes and shortened to what fits in a message.
[[nodiscard]] std::string in_quotes(std::string_view text);

}  // namespace zwidth
