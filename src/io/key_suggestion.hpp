#pragma once

#include <span>
#include <string>
#include <string_view>

namespace zwidth {

/// The candidate that `word` probably misspells, or an empty string: at most one edit per three letters.
[[nodiscard]] std::string nearest_word(std::string_view word, std::span<const std::string> candidates);

}  // namespace zwidth
