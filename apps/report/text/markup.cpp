#include "report/text/markup.hpp"

#include <array>
#include <utility>

namespace zwidth::report {

std::string escape_markup(std::string_view text) {
  std::string escaped;
  escaped.reserve(text.size());
  for (const char character : text) {
    const auto byte = static_cast<unsigned char>(character);
    switch (character) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += (byte < 0x20 && character != '\n') || byte == 0x7f ? ' ' : character;
    }
  }
  return escaped;
}

std::string inline_svg(std::string_view svg, std::string_view name) {
  const std::size_t start = svg.find("<svg");
  if (start != std::string_view::npos) svg.remove_prefix(start);
  // An HTML page knows both name spaces.
  static constexpr std::array<std::string_view, 2> dropped = {R"( xmlns="http://www.w3.org/2000/svg")",
                                                              R"( xmlns:xlink="http://www.w3.org/1999/xlink")"};
  static constexpr std::array<std::string_view, 5> references = {R"(id=")", "id='", "href='#", R"(href="#)", "url(#"};
  std::string element;
  element.reserve(svg.size() + svg.size() / 8);
  while (!svg.empty()) {
    std::string_view matched;
    for (const std::string_view text : dropped) {
      if (svg.starts_with(text)) matched = text;
    }
    if (!matched.empty()) {
      svg.remove_prefix(matched.size());
      continue;
    }
    for (const std::string_view text : references) {
      if (svg.starts_with(text)) matched = text;
    }
    if (!matched.empty()) {
      (element += matched) += std::string(name) + '-';
      svg.remove_prefix(matched.size());
    } else {
      element += svg.front();
      svg.remove_prefix(1);
    }
  }
  return element;
}

}  // namespace zwidth::report
