#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

namespace zwidth::report {

inline constexpr std::size_t no_line_end = std::numeric_limits<std::size_t>::max();

/// Where text is read.
struct TextMedium {
  std::size_t line_length = 0;  ///< characters before a paragraph is broken; 0: as its writer lays it out
  bool is_ascii = false;        ///< no letters but ASCII's: "m^2" for "m²", "us" for "µs"
};

/// What wrap(), layout() and for_medium() write for from now on. For the start of a program: not guarded.
void set_text_medium(TextMedium medium);
[[nodiscard]] const TextMedium& text_medium();

/// The text in the letters of the medium; a letter without a likeness becomes "?".
[[nodiscard]] std::string for_medium(std::string_view text);

}  // namespace zwidth::report
