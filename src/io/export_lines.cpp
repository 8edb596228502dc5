#include "io/export_lines.hpp"

#include <algorithm>
#include <utility>

#include "counted.hpp"
#include "io/prose.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {

bool ExportLine::is_empty() const {
  return std::all_of(cells.begin(), cells.end(), [](std::string_view each) { return trimmed(each).empty(); });
}

std::string beginning_of(const ExportLine& line) { return in_quotes(as_utf8(line.cell(0))); }

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

InputError ExportLines::refused(const ExportLine& line, Problem problem) const {
  return {{.file = source(), .line = line.line.number, .column = 1}, std::move(problem)};
}

InputError ExportLines::wrong_cells(const ExportLine& line, std::size_t cells, std::size_t expected,
                                    std::string what) const {
  return refused(line, {.code = ProblemCode::wrong_number_of_cells,
                        .evidence = {counted("cells", cells), counted("expected", expected)},
                        .subjects = {{"as", std::move(what)}}});
}

InputError ExportLines::no_number(const ExportLine& line, std::size_t cell, const std::string& column) const {
  const std::string_view text = line.cell(cell);
  const std::size_t place =
      text.data() == nullptr ? 1 : static_cast<std::size_t>(text.data() - line.line.text.data()) + 1;
  return {{.file = source(), .line = line.line.number, .column = place, .key = shortened(column)},
          no_number_in(text, decimal_mark_.value_or('.'))};
}

}  // namespace zwidth::internal
