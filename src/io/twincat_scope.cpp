#include "io/twincat_scope.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "counted.hpp"
#include "io/column_names.hpp"
#include "io/export_lines.hpp"
#include "io/prose.hpp"
#include "io/whole_text.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

using Kind = NumberCell::Kind;
using Read = tl::expected<void, InputError>;

constexpr std::string_view name_key = "Name";
constexpr std::string_view end_mark = "EOF";

/// Channels that share a column of times.
struct ScopeGroup {
  std::size_t time = 0;  ///< column
  std::size_t end = 0;   ///< after its last channel
  std::optional<double> last_time;
  std::size_t rows = 0;
};

/// The delimiter after the first word of a text that begins with "Name".
std::optional<char> scope_delimiter(std::string_view text) {
  if (!text.starts_with(name_key) || text.size() <= name_key.size()) return std::nullopt;
  const char next = text[name_key.size()];
  return std::string_view("\t;,: ").find(next) == std::string_view::npos ? std::nullopt : std::optional(next);
}

/// "dV" of "dV (Voltage)"; nothing of "(None)".
std::string scope_unit(std::string_view cell) {
  const std::string unit = name_in_cell(cell);
  return unit.starts_with("(") ? "" : unit.substr(0, unit.find(" ("));
}

/// A number of the header, which may have another decimal mark than the rows.
std::optional<double> header_number(std::string_view cell) {
  for (const char mark : {'.', ','}) {
    if (const auto number = read_number(cell, mark); number.kind == Kind::number) return number.value;
  }
  return std::nullopt;
}

/// A time in units of 100 ns since 1601, which a double does not hold.
std::optional<std::uint64_t> file_time(std::string_view cell) {
  constexpr std::size_t fewest_digits = 16;  // since 1632
  return cell.size() >= fewest_digits ? whole_text_as<std::uint64_t>(cell) : std::nullopt;
}

class ScopeReader {
 public:
  ScopeReader(ExportLines& lines, const RecordingOptions& options) : lines_(lines), options_(options) {
    exported_.source = lines.source();
  }

  tl::expected<ExportedColumns, InputError> read() {
    if (auto done = read_preamble(); !done) return tl::unexpected(std::move(done.error()));
    if (auto done = read_rows(); !done) return tl::unexpected(std::move(done.error()));
    finish();
    return std::move(exported_);
  }

 private:
  /// Up to the line of channels.
  Read read_preamble() {
    while (true) {
      auto next = lines_.next();
      if (!next) return tl::unexpected(std::move(next.error()));
      if (!*next) {
        return tl::unexpected(InputError{{.file = exported_.source},
                                         {.code = ProblemCode::no_columns, .subjects = {{"format", "twincat"}}}});
      }
      const ExportLine& line = **next;
      const bool begins_again = line.cell(0) == name_key && (line.line.number > 1 || count_names(line) > 1);
      if (begins_again) return take_channels(line);
      if (line.cell(0) == "Starttime of export") origin_ = file_time(line.cell(1));
      if (read_number(line.cell(0), '.').kind == Kind::number) {
        return tl::unexpected(
            lines_.refused(line, {.code = ProblemCode::line_without_header, .subjects = {{"format", "twincat"}}}));
      }
    }
  }

  static std::size_t count_names(const ExportLine& line) {
    return static_cast<std::size_t>(std::count(line.cells.begin(), line.cells.end(), name_key));
  }

  Read take_channels(const ExportLine& line) {
    std::size_t size = line.cells.size();
    if (size > 0 && line.cells.back().empty()) --size;  // a delimiter at the line's end
    for (std::size_t c = 0; c < size; ++c) {
      if (line.cells[c] == name_key) {
        if (!groups_.empty()) groups_.back().end = c;
        groups_.push_back({c, size, {}, 0});
      }
      ExportedColumn column;
      column.holds_times = line.cells[c] == name_key;
      column.name = column.holds_times ? "" : name_in_cell(line.cells[c]);
      if (column.name.empty()) column.name = std::to_string(c + 1);
      exported_.columns.push_back(std::move(column));
    }
    for (const ScopeGroup& group : groups_) {
      std::string& name = exported_.columns[group.time].name;
      const bool is_alone = groups_.size() == 1 || group.time + 1 >= group.end;
      name = is_alone ? "time [ms]" : fmt::format("time of {} [ms]", exported_.columns[group.time + 1].name);
    }
    return {};
  }

  /// A line of metadata: a key in the cell of each group's times, the channels' values beside it.
  void take_metadata(const ExportLine& line) {
    const std::string_view key = line.cell(0);
    for (std::size_t c = 0; c < exported_.columns.size(); ++c) {
      ExportedColumn& column = exported_.columns[c];
      if (column.holds_times || c >= line.cells.size()) continue;
      const std::string_view cell = line.cells[c];
      auto& [factor, offset] = column.scale;
      const auto number = header_number(cell);
      if (key == "Unit") units_.emplace_back(c, scope_unit(cell));
      if (key == "ScaleFactor" || key == "Unit ScaleFactor") factor *= number.value_or(1.0);
      if (key == "Unit ScaleFactor") offset *= number.value_or(1.0);
      if (key == "Offset" || key == "Unit Offset") offset += number.value_or(0.0);
    }
  }

  void begin_rows(std::size_t line) {
    rows_begin_ = line;
    for (const auto& [c, unit] : units_) exported_.columns[c].name = with_unit(exported_.columns[c].name, unit);
    for (const ScopeGroup& group : groups_) {
      for (std::size_t c = group.time + 1; c < group.end; ++c) {
        exported_.columns[c].time_name = exported_.columns[group.time].name;
      }
    }
    mark_columns_to_keep(exported_, options_);
  }

  Read read_rows() {
    while (true) {
      auto next = lines_.next();
      if (!next) return tl::unexpected(std::move(next.error()));
      if (!*next) break;
      const ExportLine& line = **next;
      if (line.is_empty()) continue;
      if (has_ended_) return tl::unexpected(no_row(line));
      if (line.cell(0) == end_mark) {
        has_ended_ = true;
        continue;
      }
      const std::string_view first = line.cell(0);
      const bool is_text = read_number(first, '.').kind == Kind::text && read_number(first, ',').kind == Kind::text;
      if (is_text && rows_begin_ == 0) {
        take_metadata(line);
        continue;
      }
      if (is_text) return tl::unexpected(no_row(line));
      if (rows_begin_ == 0) begin_rows(line.line.number);
      if (auto added = add_row(line); !added) return added;
    }
    if (rows_begin_ == 0) begin_rows(0);
    return {};
  }

  InputError no_row(const ExportLine& line) const {
    return lines_.refused(line, {.code = ProblemCode::line_among_rows,
                                 .subjects = {{"format", "twincat"}, {"beginning", beginning_of(line)}}});
  }

  Read add_row(const ExportLine& line) {
    std::size_t size = line.cells.size();
    if (size == exported_.columns.size() + 1 && line.cells.back().empty()) --size;
    if (line.may_be_cut_off && size < widest_) {
      exported_.remarks.push_back(warning(
          {.code = FindingCode::last_line_without_end,
           .evidence = {counted("line", line.line.number), counted("cells", size), counted("expected", widest_)}}));
      return {};
    }
    if (size > exported_.columns.size()) return tl::unexpected(wrong_size(line, size));
    for (const ScopeGroup& group : groups_) {
      if (size > group.time && size < group.end) return tl::unexpected(wrong_size(line, size));
    }
    widest_ = size;
    for (ScopeGroup& group : groups_) {
      if (size <= group.time) continue;
      if (auto added = add_to(group, line); !added) return added;
    }
    return {};
  }

  InputError wrong_size(const ExportLine& line, std::size_t size) const {
    Problem problem{.code = ProblemCode::wrong_number_of_cells,
                    .evidence = {counted("cells", size), counted("expected", exported_.columns.size())},
                    .subjects = {{"as", "channels"}}};
    if (groups_.size() > 1) problem.evidence.push_back(counted("groups", groups_.size()));
    return lines_.refused(line, std::move(problem));
  }

  Read add_to(ScopeGroup& group, const ExportLine& line) {
    const auto time = time_in(line.cells[group.time]);
    if (!time) {
      return tl::unexpected(lines_.no_number(line, group.time, exported_.columns[group.time].name));
    }
    const auto is_missing = [](std::string_view cell) { return cell.empty(); };
    if (std::isnan(*time)) {
      for (std::size_t c = group.time + 1; c < group.end; ++c) {
        if (is_missing(line.cells[c])) continue;
        return tl::unexpected(lines_.refused(line, {.code = ProblemCode::value_without_time,
                                                    .subjects = {{"column", shortened(exported_.columns[c].name)}}}));
      }
      return {};
    }
    std::vector<double> values;
    for (std::size_t c = group.time + 1; c < group.end; ++c) values.push_back(value_in(line, c));
    if (repeats(group, *time, values)) {
      ++repeated_;
      return {};
    }
    group.last_time = *time;
    add(group.time, *time, *time, group, line);
    for (std::size_t c = group.time + 1; c < group.end; ++c) {
      add(c, values[c - group.time - 1], *time, group, line);
    }
    ++group.rows;
    return {};
  }

  void add(std::size_t c, double value, double time, const ScopeGroup& group, const ExportLine& line) {
    ExportedColumn& column = exported_.columns[c];
    ++column.samples;
    if (!column.is_kept) return;
    column.lines.add(group.rows, line.line.number);
    column.values.push_back(value);
    if (!column.holds_times) column.times.push_back(time);
  }

  /// NaN where there is none; nothing where it is text.
  std::optional<double> time_in(std::string_view cell) {
    constexpr double ms_per_tick = 1e-4;
    if (const auto ticks = file_time(cell)) {
      if (!origin_) origin_ = *ticks;
      return ms_per_tick * static_cast<double>(static_cast<std::int64_t>(*ticks - *origin_));
    }
    const NumberCell number = lines_.number(cell);
    return number.kind == Kind::text ? std::nullopt : std::optional(number.value);
  }

  /// Of a kept column; the first text is told to who asks for it.
  double value_in(const ExportLine& line, std::size_t c) {
    ExportedColumn& column = exported_.columns[c];
    if (!column.is_kept) return 0.0;
    const NumberCell number = lines_.number(line.cells[c]);
    if (number.kind == Kind::text && !column.unreadable) column.unreadable = lines_.no_number(line, c, column.name);
    return number.value;
  }

  /// A slow channel's row, which the export has written once more beside a fast one.
  bool repeats(const ScopeGroup& group, double time, const std::vector<double>& values) const {
    if (group.last_time != time) return false;
    for (std::size_t c = group.time + 1; c < group.end; ++c) {
      const ExportedColumn& column = exported_.columns[c];
      const double value = values[c - group.time - 1];
      if (!column.is_kept || column.values.empty()) continue;
      const double before = column.values.back();
      if (value != before && !(std::isnan(value) && std::isnan(before))) return false;
    }
    return true;
  }

  void finish() {
    const std::size_t channels = exported_.columns.size() - groups_.size();
    const auto mark = lines_.decimal_mark();
    Finding found{.code = FindingCode::twincat_scope_export,
                  .evidence = {counted("channels", channels), counted("time_columns", groups_.size()),
                               counted("first_row", rows_begin_)}};
    if (mark) found.subjects.push_back({"decimal_mark", std::string(1, *mark)});
    exported_.remarks.insert(exported_.remarks.begin(), note(std::move(found)));
    if (repeated_ > 0) {
      exported_.remarks.push_back(
          note({.code = FindingCode::slow_rows_repeated, .evidence = {counted("rows", repeated_)}}));
    }
  }

  ExportLines& lines_;
  const RecordingOptions& options_;
  ExportedColumns exported_;
  std::vector<ScopeGroup> groups_;
  std::vector<std::pair<std::size_t, std::string>> units_;  ///< of columns
  std::optional<std::uint64_t> origin_;                     ///< of absolute times, 100 ns
  std::size_t rows_begin_ = 0;                              ///< line; 0: not yet
  std::size_t widest_ = 0;                                  ///< cells of the row before
  std::size_t repeated_ = 0;
  bool has_ended_ = false;
};

}  // namespace

bool is_twincat_scope(std::string_view text) {
  const auto delimiter = scope_delimiter(text);
  if (!delimiter) return false;
  const std::size_t end = std::min(text.find('\n'), text.size());
  const std::string again = std::string(1, *delimiter) + std::string(name_key) + *delimiter;
  if (text.substr(0, end).find(again) != std::string_view::npos) return true;
  const std::string_view second = text.substr(std::min(end + 1, text.size()));
  return second.starts_with("File" + std::string(1, *delimiter)) ||
         second.starts_with("Starttime of export" + std::string(1, *delimiter));
}

tl::expected<ExportedColumns, InputError> read_twincat_scope(TextLines text, const RecordingOptions& options,
                                                             const Progress& progress) {
  const char delimiter = *scope_delimiter(text.buffered());
  if (delimiter == ' ' || delimiter == ':') {
    return tl::unexpected(
        InputError{{.file = text.file().source(), .line = 1, .column = 1},
                   {.code = ProblemCode::separator_not_possible,
                    .subjects = {{"of", "twincat"}, {"separator", delimiter == ' ' ? "blanks" : "colons"}}}});
  }
  ExportLines lines(std::move(text), delimiter, options.decimal_mark, progress);
  return ScopeReader(lines, options).read();
}

}  // namespace zwidth::internal
