#include "io/text_table.hpp"

#include <algorithm>
#include <utility>

#include "counted.hpp"
#include "io/cell_splitter.hpp"
#include "io/prose.hpp"

namespace zwidth::internal {
namespace {

/// Lines of which the layout is found, comments not counted; a preamble may take some of them.
constexpr std::size_t lines_of_head = 200;

/// What a text table is not, by its first bytes.
struct Signature {
  std::string_view bytes;
  const char* kind;
};
using namespace std::string_view_literals;
constexpr Signature signatures[] = {
    {"\xFF\xFE<\0"sv, "trace_in_utf16"},
    {"<?xml"sv, "xml"},
    {"\xFF\xFE"sv, "utf16"},
    {"\xFE\xFF"sv, "utf16"},
    {"PK\x03\x04"sv, "sheet"},
    {"\x1F\x8B"sv, "gzip"},
    {"\xD0\xCF\x11\xE0"sv, "old_sheet"},
    {"TDSm"sv, "tdms"},
};

/// Lines that are whole in the buffered text (at its end an open one, too), without being taken. `above`: lines before.
std::vector<TextLine> head_of(std::string_view text, bool whole, std::string_view comment, std::size_t above) {
  std::vector<TextLine> lines;
  std::size_t counted = 0;
  while (!text.empty() && counted < lines_of_head) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos && !whole && !lines.empty()) break;
    std::string_view line = text.substr(0, end);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines.push_back({above + lines.size() + 1, line});
    if (!is_comment_line(line, comment)) ++counted;
    text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  }
  return lines;
}

}  // namespace

std::optional<InputError> refused_as_text(std::string_view first_bytes, const std::string& source) {
  const auto refused = [&](const char* kind) {
    return InputError{{.file = source}, {.code = ProblemCode::no_text_table, .subjects = {{"kind", kind}}}};
  };
  if (first_bytes.empty()) {
    return InputError{{.file = source}, {.code = ProblemCode::no_rows_of_numbers, .evidence = {counted("lines", 0)}}};
  }
  for (const auto& [bytes, kind] : signatures) {
    if (first_bytes.starts_with(bytes)) return refused(kind);
  }
  if (first_bytes.find('\0') != std::string_view::npos) return refused("binary");
  if (first_bytes.find('\n') == std::string_view::npos && first_bytes.find('\r') < first_bytes.size() - 1) {
    return refused("carriage_returns");
  }
  return std::nullopt;
}

TextTable::TextTable(TextLines lines, CsvDialect dialect, std::string comment, double line_length)
    : lines_(std::move(lines)), dialect_(std::move(dialect)), comment_(std::move(comment)), line_length_(line_length) {}

tl::expected<TextTable, InputError> TextTable::open(TextLines lines, const RecordingOptions& options) {
  if (auto refused = refused_as_text(lines.buffered(), lines.file().source())) {
    return tl::unexpected(std::move(*refused));
  }
  if (lines.buffered().starts_with(byte_order_mark)) lines.skip(byte_order_mark.size());
  for (std::size_t skipped = 0; skipped < options.skip_rows; ++skipped) {
    const auto line = lines.next({});
    if (!line) return tl::unexpected(line.error());
    if (*line) continue;
    return tl::unexpected(InputError{{.file = lines.file().source(), .key = "skipped rows"},
                                     {.code = ProblemCode::too_many_rows_skipped,
                                      .evidence = {counted("rows", options.skip_rows), counted("lines", skipped)}}});
  }
  const auto head = head_of(lines.buffered(), lines.buffered_to_the_end(), options.comment, options.skip_rows);
  auto dialect = detect_csv_dialect(head, options, lines.file().source());
  if (!dialect) return tl::unexpected(std::move(dialect.error()));
  const auto length = head.back().text.data() + head.back().text.size() - head.front().text.data();
  const double mean_length = static_cast<double>(length) / static_cast<double>(head.size()) + 1.0;
  return TextTable(std::move(lines), std::move(*dialect), options.comment, mean_length);
}

tl::expected<TextTable, InputError> TextTable::open(const std::string& path, const RecordingOptions& options) {
  auto file = InputFile::open(path, "recording");
  if (!file) return tl::unexpected(std::move(file.error()));
  auto lines = TextLines::start(std::move(*file));
  if (!lines) return tl::unexpected(std::move(lines.error()));
  return open(std::move(*lines), options);
}

std::vector<std::string> TextTable::names() const {
  if (has_header()) return dialect_.names;
  std::vector<std::string> numbers;
  numbers.reserve(columns());
  for (std::size_t c = 1; c <= columns(); ++c) numbers.push_back(std::to_string(c));
  return numbers;
}

std::size_t TextTable::likely_rows() const {
  constexpr double reserve = 1.05;  // later lines may be shorter than the first
  return static_cast<std::size_t>(reserve * static_cast<double>(lines_.file().size()) / line_length_) + 1;
}

tl::expected<void, InputError> TextTable::each_row(const RowVisitor& visit, const Progress& progress) {
  CellSplitter splitter(dialect_.delimiter);
  std::size_t rows = 0;
  std::size_t empty_lines = 0;          // since the last row
  std::size_t empty_lines_in_rows = 0;  // with rows on both sides
  while (true) {
    const auto next = lines_.next(progress);
    if (!next) return tl::unexpected(next.error());
    if (!*next) break;
    const TextLine& line = **next;
    if (line.number < dialect_.first_row) continue;
    const bool empty_cells = dialect_.delimiter == '\t' && line.text.find('\t') != std::string_view::npos;
    if (is_empty_line(line.text) && !empty_cells) {
      ++empty_lines;
      continue;
    }
    if (is_comment_line(line.text, comment_)) continue;
    auto cells = splitter.split(line.text);
    if (cells.size() == columns() + 1 && cells.back().empty()) cells = cells.first(columns());
    if (cells.size() != columns()) {
      if (cells.size() > columns() || !lines_.last_line_is_open() || rows == 0) {
        return tl::unexpected(wrong_cells(line, cells.size(), rows));
      }
      dialect_.remarks.push_back(warning(
          {.code = FindingCode::last_line_cut_off,
           .evidence = {counted("line", line.number), counted("cells", cells.size()), counted("expected", columns())},
           .subjects = {{"document", "recording"}}}));
      continue;
    }
    empty_lines_in_rows += std::exchange(empty_lines, 0);
    ++rows;
    if (auto visited = visit({line, cells}); !visited) return visited;
  }
  if (empty_lines_in_rows > 0) {
    dialect_.remarks.push_back(
        warning({.code = FindingCode::empty_lines_in_rows, .evidence = {counted("lines", empty_lines_in_rows)}}));
  }
  if (progress) progress(1.0);
  return {};
}

NumberCell TextTable::number(std::string_view cell) {
  if (!dialect_.decimal_mark) dialect_.decimal_mark = decimal_mark_in(cell);
  return read_number(cell, dialect_.decimal_mark.value_or('.'));
}

std::optional<std::complex<double>> TextTable::complex_number(std::string_view cell) const {
  return read_complex(cell, dialect_.decimal_mark.value_or('.'));
}

InputPlace TextTable::place(const TextRow& row, std::size_t column) const {
  const auto offset = static_cast<std::size_t>(row.cells[column].data() - row.line.text.data());
  return {.file = source(), .line = row.line.number, .column = offset + 1, .key = shortened(names()[column])};
}

InputError TextTable::no_number(const TextRow& row, std::size_t column, const std::string& as) const {
  Problem problem = no_number_in(row.cells[column], dialect_.decimal_mark.value_or('.'));
  if (!as.empty()) problem.subjects.push_back({"as", as});
  return {place(row, column), std::move(problem)};
}

InputError TextTable::wrong_cells(const TextLine& line, std::size_t cells, std::size_t rows_above) const {
  constexpr std::size_t few = 10;  // rows: above them may stand a header in which numbers were read
  Problem problem{.code = ProblemCode::wrong_number_of_cells,
                  .evidence = {counted("cells", cells), counted("expected", columns())},
                  .subjects = {{"as", has_header() ? "header" : "most_lines"}}};
  if (rows_above < few && !has_header()) problem.evidence.push_back(counted("rows", rows_above));
  return {{.file = source(), .line = line.number, .column = 1}, std::move(problem)};
}

}  // namespace zwidth::internal
