#pragma once

#include <string>
#include <string_view>

namespace zwidth::report {

/// Text made safe for HTML and SVG, between tags and inside quoted attributes. Control characters become spaces.
[[nodiscard]] std::string escape_markup(std::string_view text);

/// An SVG file as an element to stand inside an HTML page: no XML prologue, and every id and reference prefixed by
/// `name`, so that several figures of one page keep apart.
[[nodiscard]] std::string inline_svg(std::string_view svg, std::string_view name);

}  // namespace zwidth::report
