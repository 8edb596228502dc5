#include "io/controldesk_export.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "io/column_names.hpp"
#include "io/export_lines.hpp"
#include "io/prose.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

using DeskRead = tl::expected<void, InputError>;

constexpr std::string_view values_key = "trace_values";
constexpr std::string_view names_key = "trace_names";

/// The first line that begins with "trace_values", in quotes or not; empty: there is none.
std::string_view first_values(std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = trimmed(text.substr(0, end));
    const std::string_view word = line.starts_with('"') ? line.substr(1) : line;
    if (word.starts_with(values_key)) {
      const std::string_view rest = word.substr(values_key.size());
      const std::string_view after = rest.starts_with('"') ? rest.substr(1) : rest;
      if (!after.empty() && std::string_view(",;\t").find(after.front()) != std::string_view::npos) return after;
    }
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return {};
}

class DeskReader {
 public:
  explicit DeskReader(ExportLines& lines) : lines_(lines) { exported_.source = lines.source(); }

  tl::expected<ExportedColumns, InputError> read() {
    if (auto taken = lines_.for_each([this](const ExportLine& line) { return take(line); }); !taken) {
      return tl::unexpected(std::move(taken.error()));
    }
    exported_.remarks.insert(
        exported_.remarks.begin(),
        note({.code = FindingCode::controldesk_export,
              .evidence = {counted("signals", exported_.columns.size() - sections_), counted("sections", sections_)}}));
    return std::move(exported_);
  }

 private:
  DeskRead take(const ExportLine& line) {
    if (line.is_empty()) {
      is_in_rows_ = false;
      return {};
    }
    const std::string key = lower_case(line.cell(0));
    if (key == values_key) {
      if (auto begun = begin_section(line); !begun) return begun;
      return add_row(line);
    }
    if (is_in_rows_ && key.empty()) return add_row(line);
    if (key.empty() || read_number(key, '.').kind == NumberCell::Kind::number) {
      return tl::unexpected(
          lines_.refused(line, {.code = ProblemCode::line_without_header, .subjects = {{"format", "controldesk"}}}));
    }
    if (is_in_rows_) {
      return tl::unexpected(
          lines_.refused(line, {.code = ProblemCode::line_among_rows,
                                .subjects = {{"format", "controldesk"}, {"beginning", beginning_of(line)}}}));
    }
    auto& cells = metadata_[key];
    cells.clear();
    for (const std::string_view cell : line.cells) cells.push_back(name_in_cell(cell));
    return {};
  }

  [[nodiscard]] std::string metadata(const std::string& key, std::size_t cell) const {
    const auto found = metadata_.find(key);
    return found == metadata_.end() || cell >= found->second.size() ? "" : found->second[cell];
  }

  [[nodiscard]] std::string unit(std::size_t cell) const {
    const std::string one = metadata("unit", cell);
    return one.empty() ? metadata("units", cell) : one;
  }

  DeskRead begin_section(const ExportLine& line) {
    const bool has_names = metadata_.contains(std::string(names_key)) || metadata_.contains("path");
    constexpr std::size_t fewest = 3;  // the key, a time, a value
    std::size_t cells = line.cells.size();
    while (cells > fewest && line.cells[cells - 1].empty() && name_of_signal(cells - 1).empty()) --cells;
    if (!has_names || cells < fewest) {
      return tl::unexpected(lines_.refused(
          line, {.code = ProblemCode::section_incomplete, .evidence = {counted("values", has_names ? 0 : cells - 1)}}));
    }
    ++sections_;
    cells_ = cells;
    begin_ = exported_.columns.size();
    is_in_rows_ = true;
    const std::string time_unit = unit(1);
    for (std::size_t c = 1; c < cells; ++c) {
      ExportedColumn column;
      column.name = with_unit(
          name_of_signal(c).empty() ? fmt::format("{}", exported_.columns.size() + 1) : name_of_signal(c), unit(c));
      column.is_kept = true;
      column.holds_times = c == 1;
      exported_.columns.push_back(std::move(column));
    }
    const std::string of = sections_ == 1 ? "time" : "time of " + exported_.columns[begin_ + 1].name;
    exported_.columns[begin_].name = with_unit(of, time_unit.empty() ? "s" : time_unit);
    for (std::size_t c = begin_ + 1; c < exported_.columns.size(); ++c) {
      exported_.columns[c].time_name = exported_.columns[begin_].name;
    }
    metadata_.clear();
    return {};
  }

  [[nodiscard]] std::string name_of_signal(std::size_t cell) const {
    const std::string name = metadata(std::string(names_key), cell);
    if (!name.empty()) return name;
    const std::string path = metadata("path", cell);
    return path.substr(path.find_last_of("/\\") + 1);
  }

  DeskRead add_row(const ExportLine& line) {
    std::size_t size = line.cells.size();
    while (size > cells_ && line.cells[size - 1].empty()) --size;
    if (size != cells_) {
      if (line.may_be_cut_off && size < cells_) {
        exported_.remarks.push_back(warning(
            {.code = FindingCode::last_line_cut_off,
             .evidence = {counted("line", line.line.number), counted("cells", size), counted("expected", cells_)},
             .subjects = {{"document", "export"}}}));
        return {};
      }
      return tl::unexpected(lines_.wrong_cells(line, size, cells_, "section"));
    }
    const NumberCell time = lines_.number(line.cells[1]);
    if (time.kind != NumberCell::Kind::number)
      return tl::unexpected(lines_.no_number(line, 1, exported_.columns[begin_].name));
    for (std::size_t c = 1; c < cells_; ++c) {
      ExportedColumn& column = exported_.columns[begin_ + c - 1];
      const NumberCell number = lines_.number(line.cells[c]);
      if (number.kind == NumberCell::Kind::text && !column.unreadable) {
        column.unreadable = lines_.no_number(line, c, column.name);
      }
      column.lines.add(column.samples++, line.line.number);
      column.values.push_back(number.value);
      if (c > 1) column.times.push_back(time.value);
    }
    return {};
  }

  ExportLines& lines_;
  ExportedColumns exported_;
  std::map<std::string, std::vector<std::string>> metadata_;  ///< of the next section, by key
  std::size_t sections_ = 0;
  std::size_t begin_ = 0;  ///< the section's column of times
  std::size_t cells_ = 0;  ///< of the section's rows
  bool is_in_rows_ = false;
};

}  // namespace

bool is_controldesk_export(std::string_view text) { return !first_values(text).empty(); }

tl::expected<ExportedColumns, InputError> read_controldesk_export(TextLines text, const RecordingOptions& options,
                                                                  const Progress& progress) {
  const char delimiter = first_values(text.buffered()).front();
  ExportLines lines(std::move(text), delimiter, options.decimal_mark, progress);
  return DeskReader(lines).read();
}

}  // namespace zwidth::internal
