#include "report/document.hpp"

#include <fmt/format.h>

#include <utility>

#include "report/page/html_page.hpp"

namespace zwidth::report {

void Document::part(std::string in_text, std::string on_page) {
  if (!content_.empty()) {
    if (!is_page() && !written_.empty()) written_ += '\n';
    if (!heading_.empty()) written_ += is_page() ? element("h2", heading_) : wrap(heading_, line_width, 0);
    written_ += std::exchange(content_, {});
  }
  heading_ = is_page() ? std::move(on_page) : std::move(in_text);
}

void Document::paragraph(const std::optional<std::string>& text) {
  if (text && !text->empty()) content_ += is_page() ? element("p", *text) : wrap(*text, line_width, 0);
}

void Document::list(const std::vector<std::string>& items) {
  if (items.empty()) return;
  std::string lines;
  for (const std::string& each : items) lines += is_page() ? element("li", each) : bulleted(each);
  content_ += is_page() ? fmt::format("<ul>\n{}</ul>\n", lines) : lines;
}

void Document::table(const TextTable& table) {
  if (table.rows.size() > 1) content_ += is_page() ? html_table(table) : layout(table);
}

void Document::rows(std::span<const LabelledText> rows) {
  if (rows.empty()) return;
  content_ += is_page() ? html_rows(rows) : lines_of(rows);
}

void Document::figure(std::string_view name, std::string_view caption,
                      const std::function<std::optional<std::string>()>& draw) {
  if (!is_page()) return;
  if (const std::optional<std::string> svg = draw()) content_ += html_figure(*svg, name, caption);
}

std::string Document::str() && {
  part();
  return std::move(written_);
}

}  // namespace zwidth::report
