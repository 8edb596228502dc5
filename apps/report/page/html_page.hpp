#pragma once

#include <span>
#include <string>
#include <string_view>

#include "report/text/text_table.hpp"
#include "zwidth/trust.hpp"

namespace zwidth::report {

/// A whole HTML file: self-contained, light, and made to print. `body` is markup; `title` and `note` are text. Its last line is the
/// note, the program's version and the day, in UTC (SOURCE_DATE_EPOCH where that is set).
[[nodiscard]] std::string html_page(std::string_view title, std::string_view body, std::string_view note = {});

/// What a page says first, in a box whose edge has the verdict's colour.
[[nodiscard]] std::string answer_element(Trust::Verdict verdict, std::string_view markup);

/// The table as HTML, its texts escaped.
[[nodiscard]] std::string html_table(const TextTable& table);

/// A label and its text a line, as a table without headings.
[[nodiscard]] std::string html_rows(std::span<const LabelledText> rows);

/// "<TAG>text</TAG>", with the text escaped.
[[nodiscard]] std::string element(std::string_view tag, std::string_view text);

/// A figure element around an SVG file, ids kept apart by `name`; `caption` is text.
[[nodiscard]] std::string html_figure(std::string_view svg, std::string_view name, std::string_view caption);

}  // namespace zwidth::report
