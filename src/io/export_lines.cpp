#include "io/export_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "io/prose.hpp"

namespace zwidth::internal {

bool ExportLine::is_empty() const {
  return std::all_of(cells.begin(), cells.end(), [](std::string_view each) { return trimmed(each).empty(); });
}

tl::expected<std::optional<ExportLine>, InputError> ExportLines::next() {
  const auto line = lines_.next(progress_);
  if (!line) return tl::unexpected(line.error());
  if (!*line) {
    if (progress_) progress_(1.0);
    return std::nullopt;
  }
  return ExportLine{**line, splitter_.split((*line)->text), lines_.last_line_is_open()};
}

NumberCell ExportLines::number(std::string_view cell) {
  if (!decimal_mark_) decimal_mark_ = decimal_mark_in(cell);
  return read_number(cell, decimal_mark_.value_or('.'));
}

InputError ExportLines::refused(const ExportLine& line, std::string what, OptionText allowed) const {
  return {source(), line.line.number, 1, "", std::move(what), std::move(allowed)};
}

InputError ExportLines::no_number(const ExportLine& line, std::size_t cell, const std::string& column) const {
  const std::string_view text = line.cell(cell);
  const char mark = decimal_mark_.value_or('.');
  const std::size_t place =
      text.data() == nullptr ? 1 : static_cast<std::size_t>(text.data() - line.line.text.data()) + 1;
  return {source(),
          line.line.number,
          place,
          shortened(column),
          why_no_number(text, mark),
          fmt::format("must be a number such as {}", mark == ',' ? "-1,5e-3" : "-1.5e-3")};
}

}  // namespace zwidth::internal
