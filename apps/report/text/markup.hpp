#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace zwidth::report {

/// Text made safe for HTML and SVG, between tags and inside quoted attributes. Control characters become spaces.
[[nodiscard]] std::string escape_markup(std::string_view text);

/// A symbol of our texts at this place ("K_CR", "t_d", "G_m"), with what stands below the line; nothing within a word.
struct Symbol {
  std::string_view text;
  std::string_view base;
  std::string_view subscript;
};
[[nodiscard]] const Symbol* symbol_at(std::string_view text, std::size_t at);

/// Text for HTML with the subscripts of its symbols: "K<sub>CR</sub>".
[[nodiscard]] std::string html_text(std::string_view text);

/// An SVG file as an element to stand inside an HTML page: no XML prologue, and every id and reference prefixed by
/// `name`, so that several figures of one page keep apart.
[[nodiscard]] std::string inline_svg(std::string_view svg, std::string_view name);

}  // namespace zwidth::report
