#pragma once

#include <span>
#include <string>
#include <string_view>

namespace zwidth {

/// `text` cut to what fits in a message.
[[nodiscard]] std::string shortened(std::string_view text);

/// `text` in double quotes and shortened to what fits in a message.
[[nodiscard]] std::string in_quotes(std::string_view text);

/// `words` as a list in prose: a, b, c.
[[nodiscard]] std::string listed(std::span<const std::string> words);

}  // namespace zwidth
