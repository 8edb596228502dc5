#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace zwidth::report {

enum class Align { left, right };

/// Columns of text, each as wide as its widest cell.
struct TextTable {
  std::vector<Align> alignment;                ///< one per column
  std::vector<std::vector<std::string>> rows;  ///< the first holds the headings; each as long as `alignment`
};

/// Lays the table out with two spaces before each column; no trailing spaces. In the letters of the text_medium().
[[nodiscard]] std::string layout(const TextTable& table);

/// Characters of the longest line.
[[nodiscard]] std::size_t width_of(std::string_view lines);

inline constexpr std::size_t line_width = 100;  ///< of text to read

/// Breaks text at spaces into lines of at most `width` characters, each after `indent` spaces.
[[nodiscard]] std::string broken(std::string_view text, std::size_t width, std::size_t indent);

/// The same for who reads the text: in lines as long as the text_medium() has them, or else of `width`, and its letters.
[[nodiscard]] std::string wrap(std::string_view text, std::size_t width, std::size_t indent);

/// wrap() to `line_width`, the label at the start of the first line.
[[nodiscard]] std::string labelled(std::string_view label, std::string_view text, std::size_t indent = 22);

/// What stands in one line of an answer: "K_CR measured", "8.85 kN/m at 6.14 Hz".
struct LabelledText {
  std::string label;  ///< empty: more of the one before
  std::string text;
};

/// Each labelled(), after two spaces.
[[nodiscard]] std::string lines_of(std::span<const LabelledText> rows);

/// An item of a list: "  - text".
[[nodiscard]] inline std::string bulleted(std::string_view text) { return labelled("  - ", text, 4); }

/// At most `width` characters of UTF-8 text. What is cut out, in the middle, leaves an ellipsis: names that are alike
/// differ at either end. width > 0.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t width);

}  // namespace zwidth::report
