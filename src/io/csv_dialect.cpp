#include "io/csv_dialect.hpp"

#include <algorithm>
#include <map>
#include <tuple>
#include <utility>

#include "counted.hpp"
#include "io/cell_splitter.hpp"
#include "io/column_names.hpp"
#include "io/column_unit.hpp"
#include "io/number_cell.hpp"
#include "io/prose.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

using Kind = NumberCell::Kind;

/// How cells may be told apart and read.
struct Notation {
  char delimiter = ',';
  char decimal_mark = '.';
};

/// A number whose decimal mark is the delimiter must stand in quotes.
constexpr Notation quoted_only{',', ','};

/// In the order of preference where several read a text equally well.
constexpr Notation notations[] = {{';', '.'}, {';', ','}, {'\t', '.'}, {'\t', ','},
                                  {',', '.'}, {' ', '.'}, {' ', ','},  quoted_only};

struct Line {
  std::size_t number = 0;
  std::vector<std::string_view> cells;
  std::vector<Kind> kinds;

  [[nodiscard]] bool has(Kind kind) const { return std::find(kinds.begin(), kinds.end(), kind) != kinds.end(); }
};

Kind kind_of(std::string_view cell, char decimal_mark) {
  const Kind kind = read_number(cell, decimal_mark).kind;
  return kind == Kind::text && read_complex(cell, decimal_mark) ? Kind::number : kind;
}

Line cut(const TextLine& text, const Notation& notation) {
  Line line{text.number, {}, {}};
  CellSplitter splitter(notation.delimiter);
  const auto cells = splitter.split(text.text);
  line.cells.assign(cells.begin(), cells.end());
  for (const std::string_view cell : cells) line.kinds.push_back(kind_of(cell, notation.decimal_mark));
  return line;
}

/// The first lines of a text, read in one notation.
class Reading {
 public:
  Reading(std::span<const TextLine> content, const Notation& notation) : notation_(notation) {
    for (const TextLine& text : content) lines_.push_back(cut(text, notation));
    count_columns();
    find_first_row();
    find_names();
  }

  [[nodiscard]] bool is_table() const { return first_row_ < lines_.size(); }
  [[nodiscard]] const Notation& notation() const { return notation_; }
  [[nodiscard]] std::size_t columns() const { return columns_; }
  [[nodiscard]] std::size_t first_row() const { return first_row_; }  ///< index of a line
  /// Index of the first line with the cells of a row; what stands between first_row() and it is a row
  /// with a fault or a line of a header.
  [[nodiscard]] std::size_t first_clean_row() const { return std::max(first_row_, first_clean_row_); }
  /// Text in a column of numbers; or nothing at a line's beginning, where every row begins with a number.
  [[nodiscard]] bool is_no_cell_of_a_row(const Line& line, std::size_t column) const {
    if (line.kinds[column] == Kind::text) return balance_[column] > 0;
    return column == 0 && line.cells[0].empty() && begins_with_numbers_;
  }
  [[nodiscard]] const std::vector<Line>& lines() const { return lines_; }
  [[nodiscard]] std::optional<std::size_t> names() const { return names_; }  ///< index of the line of names
  [[nodiscard]] std::optional<std::size_t> units() const { return units_; }  ///< index of the line of units below

  /// Whether a line has as many cells as the table has columns; one more is that of a delimiter at the line's end.
  [[nodiscard]] bool fits(const Line& line) const {
    const std::size_t size = line.cells.size();
    return size == columns_ || (size == columns_ + 1 && line.cells.back().empty());
  }

  /// The user says that there is a header, or that there is none.
  void take_header_as(RecordingOptions::Header header) {
    if (header == RecordingOptions::Header::absent) {
      first_row_ = first_clean_row_ = 0;
      names_.reset();
      units_.reset();
    } else if (header == RecordingOptions::Header::present && !names_) {
      names_ = 0;
      first_row_ = std::max<std::size_t>(1, first_row_);
    }
  }

  /// What makes one reading better than another, the first difference counting: what stands before the rows is a
  /// header (or nothing does), several columns, the share of the rows' cells that are numbers, the number of columns.
  [[nodiscard]] std::tuple<bool, bool, double, std::size_t> merit() const {
    if (!is_table()) return {};
    const double share = share_of_numbers();
    return {share >= 0.5 && header_is_plausible(), columns_ > 1, share, columns_};
  }

 private:
  /// Lines from here on are taken to be rows: a header may be long, but not longer than the table.
  [[nodiscard]] std::size_t middle() const { return lines_.size() / 2; }

  [[nodiscard]] std::ptrdiff_t texts_in(const Line& line) const {
    return std::count(line.kinds.begin(), line.kinds.begin() + static_cast<std::ptrdiff_t>(columns_), Kind::text);
  }

  [[nodiscard]] double share_of_numbers() const {
    std::size_t numbers = 0;
    std::size_t cells = 0;
    for (std::size_t i = first_row_; i < lines_.size(); ++i) {
      cells += std::max(columns_, lines_[i].cells.size());
      if (fits(lines_[i])) numbers += columns_ - static_cast<std::size_t>(texts_in(lines_[i]));
    }
    return static_cast<double>(numbers) / static_cast<double>(cells);
  }

  /// A name with a delimiter in it is several names, read in the wrong notation.
  [[nodiscard]] bool header_is_plausible() const {
    if (!names_) return first_row_ == 0;
    const auto& names = lines_[*names_].cells;
    return std::all_of(names.begin(), names.end(),
                       [](std::string_view name) { return name.find_first_of(",;\t") == std::string_view::npos; });
  }

  /// The most common number of cells (of several, the largest); one less where a delimiter ends every line.
  void count_columns() {
    std::map<std::size_t, std::size_t> lines_of;
    for (std::size_t i = middle(); i < lines_.size(); ++i) ++lines_of[lines_[i].cells.size()];
    const auto less_common = [](const auto& a, const auto& b) { return a.second < b.second; };
    columns_ = std::max_element(lines_of.rbegin(), lines_of.rend(), less_common)->first;
    const bool delimiter_ends = columns_ > 1 && std::all_of(lines_.begin(), lines_.end(), [&](const Line& line) {
                                  return line.cells.size() != columns_ || line.cells.back().empty();
                                });
    if (delimiter_ends) --columns_;
  }

  /// The first line that has a number in one column at least, and in none what no row has there.
  void find_first_row() {
    std::vector<std::ptrdiff_t>& balance = balance_;
    balance.assign(columns_, 0);
    for (std::size_t i = middle(); i < lines_.size(); ++i) {
      if (!fits(lines_[i])) continue;
      for (std::size_t c = 0; c < columns_; ++c) {
        const Kind kind = lines_[i].kinds[c];
        balance[c] += kind == Kind::text ? -1 : kind == Kind::number ? 1 : 0;
      }
      begins_with_numbers_ = begins_with_numbers_ && lines_[i].kinds[0] == Kind::number;
    }
    const auto is_row = [&](const Line& line) {
      if (!fits(line) || !line.has(Kind::number)) return false;
      for (std::size_t c = 0; c < columns_; ++c) {
        if (is_no_cell_of_a_row(line, c)) return false;
      }
      return true;
    };
    const auto row = std::find_if(lines_.begin(), lines_.end(), is_row);
    first_row_ = static_cast<std::size_t>(row - lines_.begin());
    first_clean_row_ = first_row_;
    const bool only_text = std::all_of(balance.begin(), balance.end(), [](std::ptrdiff_t b) { return b <= 0; });
    if (only_text || !is_table()) {
      first_row_ = lines_.size();
      return;
    }
    // A line with a number below a line without one is a row with a fault, not the header.
    const auto may_be_names = [&](std::size_t i) { return fits(lines_[i]) && !lines_[i].has(Kind::number); };
    while (first_row_ >= 2 && fits(lines_[first_row_ - 1]) && lines_[first_row_ - 1].has(Kind::number) &&
           (may_be_names(first_row_ - 2) || lines_[first_row_ - 2].has(Kind::number))) {
      --first_row_;
    }
  }

  void find_names() {
    if (!is_table() || first_row_ == 0 || !fits(lines_[first_row_ - 1])) return;
    const auto is_units = [](std::string_view cell) { return cell.empty() || is_unit(cell); };
    const auto& last = lines_[first_row_ - 1].cells;
    names_ = first_row_ - 1;
    if (first_row_ >= 2 && fits(lines_[first_row_ - 2]) && std::all_of(last.begin(), last.end(), is_units)) {
      units_ = names_;
      names_ = first_row_ - 2;
    }
  }

  Notation notation_;
  std::vector<Line> lines_;
  std::size_t columns_ = 0;
  std::vector<std::ptrdiff_t> balance_;  ///< of numbers over texts, by column
  bool begins_with_numbers_ = true;      ///< every line of the second half
  std::size_t first_row_ = 0;
  std::size_t first_clean_row_ = 0;
  std::optional<std::size_t> names_;
  std::optional<std::size_t> units_;
};

/// A column without a name is called by its number.
std::vector<std::string> header_names(const Reading& reading) {
  std::vector<std::string> columns;
  for (std::size_t c = 0; c < reading.columns(); ++c) {
    columns.push_back(name_in_cell(reading.lines()[*reading.names()].cells[c]));
    if (columns.back().empty()) columns.back() = std::to_string(c + 1);
    if (!reading.units()) continue;
    const std::string unit = name_in_cell(reading.lines()[*reading.units()].cells[c]);
    if (!unit.empty()) columns.back() = with_unit(columns.back(), unit);
  }
  return columns;
}

/// Names in the comment right before the first row ("# t, F, x"), where they are as many as the columns.
std::vector<std::string> names_in_comment(std::span<const TextLine> head, const RecordingOptions& options,
                                          const Reading& reading) {
  const TextLine* comment = nullptr;
  for (const TextLine& line : head) {
    if (line.number >= reading.lines()[reading.first_row()].number) break;
    if (is_comment_line(line.text, options.comment)) comment = &line;
  }
  if (comment == nullptr) return {};
  std::string_view text = comment->text;
  text.remove_prefix(std::min(text.find_first_not_of(options.comment + " \t"), text.size()));
  const Line line = cut({comment->number, text}, reading.notation());
  const bool named = line.cells.size() == reading.columns() && !line.has(Kind::number) && line.has(Kind::text);
  if (!named) return {};
  std::vector<std::string> columns;
  for (const std::string_view cell : line.cells) columns.push_back(name_in_cell(cell));
  return columns;
}

/// The mark that the first rows show.
std::optional<char> shown_mark(const Reading& reading, const RecordingOptions& options) {
  if (options.decimal_mark) return options.decimal_mark;
  const char mark = reading.notation().decimal_mark;
  if (mark == '.' && reading.notation().delimiter == ',') return mark;
  for (std::size_t i = reading.first_row(); i < reading.lines().size(); ++i) {
    const Line& line = reading.lines()[i];
    for (std::size_t c = 0; c < line.cells.size(); ++c) {
      if (line.kinds[c] == Kind::number && line.cells[c].find(mark) != std::string_view::npos) return mark;
    }
  }
  return std::nullopt;
}

Remark description(const CsvDialect& dialect, const Reading& reading) {
  Finding found{.code = FindingCode::text_table,
                .evidence = {counted("columns", dialect.columns), counted("first_row", dialect.first_row)}};
  if (dialect.columns != 1) found.subjects.push_back({"delimiter", std::string(1, dialect.delimiter)});
  if (dialect.decimal_mark) found.subjects.push_back({"decimal_mark", std::string(1, *dialect.decimal_mark)});
  if (reading.names()) {
    found.evidence.push_back(counted("header", reading.lines()[*reading.names()].number));
  } else {
    found.subjects.push_back({"names", dialect.names.empty() ? "none" : "comment"});
  }
  return note(std::move(found));
}

tl::unexpected<InputError> no_table(std::span<const TextLine> content, const std::string& source) {
  return tl::unexpected(InputError{{.file = source},
                                   {.code = ProblemCode::no_rows_of_numbers,
                                    .evidence = {counted("lines", content.size())},
                                    .subjects = {{"beginning", in_quotes(as_utf8(content.front().text))}}}});
}

/// A line of text above the rows, in a column that holds numbers: never a sample, whichever columns are asked for.
std::optional<InputError> text_above_the_rows(const Reading& reading, const std::string& source) {
  if (reading.first_row() == reading.first_clean_row()) return std::nullopt;
  const Line& line = reading.lines()[reading.first_row()];
  for (std::size_t c = 0; c < std::min(reading.columns(), line.cells.size()); ++c) {
    if (!reading.is_no_cell_of_a_row(line, c)) continue;
    Problem problem = no_number_in(line.cells[c], reading.notation().decimal_mark);
    problem.evidence.push_back(counted("line", reading.lines()[reading.first_clean_row()].number - 1));
    problem.subjects.push_back({"as", "header"});
    return InputError{{.file = source,
                       .line = line.number,
                       .column = 1,
                       .key = reading.names() ? shortened(header_names(reading)[c]) : std::to_string(c + 1)},
                      std::move(problem)};
  }
  return std::nullopt;
}

std::optional<InputError> refused_options(const RecordingOptions& options, const std::string& source) {
  constexpr std::string_view delimiters = ",;\t ";
  if (options.delimiter && delimiters.find(*options.delimiter) == std::string_view::npos) {
    return InputError{{.file = source, .key = "delimiter"},
                      {.code = ProblemCode::separator_not_possible, .subjects = {{"of", "delimiter"}}}};
  }
  if (options.decimal_mark && *options.decimal_mark != '.' && *options.decimal_mark != ',') {
    return InputError{{.file = source, .key = "decimal mark"},
                      {.code = ProblemCode::separator_not_possible, .subjects = {{"of", "decimal_mark"}}}};
  }
  if (options.delimiter == ',' && options.decimal_mark == ',') {
    return InputError{{.file = source, .key = "decimal mark"}, {.code = ProblemCode::decimal_mark_is_delimiter}};
  }
  return std::nullopt;
}

/// The notation that reads the lines best, among those that the options allow (refused_options() leaves one at least).
Reading best_reading(std::span<const TextLine> content, const RecordingOptions& options) {
  const bool has_quotes = std::any_of(content.begin(), content.end(), [](const TextLine& line) {
    return line.text.find('"') != std::string_view::npos;
  });
  std::optional<Reading> best;
  for (const Notation& notation : notations) {
    if (notation.delimiter == notation.decimal_mark && !has_quotes) continue;
    if (options.delimiter && *options.delimiter != notation.delimiter) continue;
    if (options.decimal_mark && *options.decimal_mark != notation.decimal_mark) continue;
    Reading reading(content, notation);
    if (!best || reading.merit() > best->merit()) best = std::move(reading);
  }
  return std::move(*best);
}

}  // namespace

bool is_empty_line(std::string_view line) { return trimmed(line).empty(); }

bool is_comment_line(std::string_view line, std::string_view comment) {
  const std::size_t begin = line.find_first_not_of(" \t");
  return begin != std::string_view::npos && comment.find(line[begin]) != std::string_view::npos;
}

tl::expected<CsvDialect, InputError> detect_csv_dialect(std::span<const TextLine> head, const RecordingOptions& options,
                                                        const std::string& source) {
  if (auto refused = refused_options(options, source)) return tl::unexpected(std::move(*refused));
  std::vector<TextLine> content;
  for (const TextLine& line : head) {
    if (!is_empty_line(line.text) && !is_comment_line(line.text, options.comment)) content.push_back(line);
  }
  if (content.empty()) {
    return tl::unexpected(InputError{
        {.file = source}, {.code = ProblemCode::no_rows_of_numbers, .evidence = {counted("lines", head.size())}}});
  }
  Reading reading = best_reading(content, options);
  reading.take_header_as(options.header);
  if (!reading.is_table()) return no_table(content, source);
  if (reading.names() && !reading.fits(reading.lines()[*reading.names()])) {
    const Line& header = reading.lines()[*reading.names()];
    return tl::unexpected(
        InputError{{.file = source, .line = header.number, .column = 1},
                   {.code = ProblemCode::wrong_number_of_cells,
                    .evidence = {counted("cells", header.cells.size()), counted("expected", reading.columns()),
                                 counted("line", header.number)},
                    .subjects = {{"as", "rows"}}}});
  }
  if (auto refusal = text_above_the_rows(reading, source)) return tl::unexpected(std::move(*refusal));

  CsvDialect dialect;
  dialect.delimiter = reading.notation().delimiter;
  dialect.decimal_mark = shown_mark(reading, options);
  dialect.columns = reading.columns();
  dialect.first_row = reading.lines()[reading.first_row()].number;
  if (reading.names()) {
    dialect.names = header_names(reading);
  } else if (options.header == RecordingOptions::Header::detect) {
    dialect.names = names_in_comment(head, options, reading);
  }
  dialect.remarks.push_back(description(dialect, reading));
  if (reading.names() && reading.lines()[*reading.names()].has(Kind::number)) {
    dialect.remarks.push_back(warning({.code = FindingCode::header_with_numbers,
                                       .evidence = {counted("line", reading.lines()[*reading.names()].number)}}));
  }
  return dialect;
}

}  // namespace zwidth::internal
