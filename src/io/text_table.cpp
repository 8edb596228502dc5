#include "io/text_table.hpp"

#include <fmt/format.h>

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
  std::string_view what;
  std::string_view remedy;
};
using namespace std::string_view_literals;
constexpr Signature signatures[] = {
    {"\xFF\xFE<\0"sv, "is XML in UTF-16, as the trace of a controller is",
     "must be a text table: save the trace as CSV, in CODESYS as *.trace.csv"},
    {"<?xml"sv, "is XML", "must be a text table: save the trace as CSV, in CODESYS as *.trace.csv"},
    {"\xFF\xFE"sv, "is text in UTF-16", "must be UTF-8 or ASCII: convert it with iconv -f UTF-16 -t UTF-8"},
    {"\xFE\xFF"sv, "is text in UTF-16", "must be UTF-8 or ASCII: convert it with iconv -f UTF-16 -t UTF-8"},
    {"PK\x03\x04"sv, "is a ZIP archive or a spreadsheet", "must be a recording: save the sheet as CSV"},
    {"\x1F\x8B"sv, "is compressed with gzip", "must be a recording: unpack it with gunzip"},
    {"\xD0\xCF\x11\xE0"sv, "is an old spreadsheet or document", "must be a recording: save the sheet as CSV"},
    {"TDSm"sv, "is a TDMS file", "must be a text table, a MAT file or a UFF file: export it as CSV"},
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

std::string in_words(std::size_t cells) { return cells == 1 ? "1 cell" : fmt::format("{} cells", cells); }

}  // namespace

std::optional<InputError> refused_as_text(std::string_view first_bytes, const std::string& source) {
  const auto refused = [&](std::string_view what, std::string_view allowed) {
    return InputError{source, 0, 0, "", std::string(what), std::string(allowed)};
  };
  if (first_bytes.empty()) return refused("is empty", "must be a recording");
  for (const auto& [bytes, what, remedy] : signatures) {
    if (first_bytes.starts_with(bytes)) return refused(what, remedy);
  }
  if (first_bytes.find('\0') != std::string_view::npos) {
    return refused("is binary data", "must be a text table, a MAT file (v5 or v7.3) or a UFF file (dataset 58)");
  }
  if (first_bytes.find('\n') == std::string_view::npos && first_bytes.find('\r') < first_bytes.size() - 1) {
    return refused("ends its lines with a carriage return alone", "must end them with a line feed, before it or not");
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
    return tl::unexpected(InputError{lines.file().source(), 0, 0, "skipped rows",
                                     fmt::format("are {}, and the file has {} lines", options.skip_rows, skipped),
                                     "must be fewer (`skip_rows`)"});
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

InputError TextTable::no_number(const TextRow& row, std::size_t column) const {
  const std::string_view cell = row.cells[column];
  const auto place = static_cast<std::size_t>(cell.data() - row.line.text.data()) + 1;
  return {source(),
          row.line.number,
          place,
          shortened(names()[column]),
          why_no_number(cell, dialect_.decimal_mark.value_or('.')),
          fmt::format("must be a number such as {}", dialect_.decimal_mark == ',' ? "-1,5e-3" : "-1.5e-3")};
}

InputError TextTable::wrong_cells(const TextLine& line, std::size_t cells, std::size_t rows_above) const {
  constexpr std::size_t few = 10;  // rows: above them may stand a header in which numbers were read
  return {source(),
          line.number,
          1,
          "",
          fmt::format("has {}", in_words(cells)),
          OptionText(fmt::format("must have {} as {}", in_words(columns()),
                                 has_header() ? "the header has" : "most of the first lines have")) +
              (rows_above < few && !has_header() ? "; lines of a header can be passed over (`skip_rows`)" : "")};
}

}  // namespace zwidth::internal
