#include "report/text/markup.hpp"

#include <algorithm>
#include <array>
#include <cctype>
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

const Symbol* symbol_at(std::string_view text, std::size_t at) {
  static constexpr std::array<Symbol, 9> symbols = {{{"K_CR", "K", "CR"},
                                                     {"t_d", "t", "d"},
                                                     {"G_d", "G", "d"},
                                                     {"G_c", "G", "c"},
                                                     {"G_m", "G", "m"},
                                                     {"k_c", "k", "c"},
                                                     {"b_c", "b", "c"},
                                                     {"f_c", "f", "c"},
                                                     {"F_c", "F", "c"}}};
  const auto is_of_word = [](char c) { return c == '_' || std::isalnum(static_cast<unsigned char>(c)) != 0; };
  if (at > 0 && is_of_word(text[at - 1])) return nullptr;
  const auto* const found = std::ranges::find_if(symbols, [&](const Symbol& each) {
    const std::size_t end = at + each.text.size();
    return text.substr(at).starts_with(each.text) && (end >= text.size() || !is_of_word(text[end]));
  });
  return found == symbols.end() ? nullptr : found;
}

std::string html_text(std::string_view text) {
  std::string marked;
  std::size_t plain = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const Symbol* symbol = symbol_at(text, at);
    if (!symbol) continue;
    marked += escape_markup(text.substr(plain, at - plain));
    ((marked += symbol->base) += "<sub>") += symbol->subscript;
    marked += "</sub>";
    plain = at + symbol->text.size();
  }
  return marked + escape_markup(text.substr(plain));
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
