#include "io/codesys_trace.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
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

using TraceRead = tl::expected<void, InputError>;

/// "Variable" of "3.Variable"; nothing of another key.
std::string_view key_of_variable(std::string_view key) {
  const std::size_t point = key.find('.');
  if (point == 0 || point == std::string_view::npos) return {};
  const std::string_view number = key.substr(0, point);
  const bool is_number = std::all_of(number.begin(), number.end(), [](char c) { return c >= '0' && c <= '9'; });
  return is_number ? key.substr(point + 1) : std::string_view();
}

std::optional<std::uint32_t> flags_in(std::string_view cell) {
  const bool is_hexadecimal = cell.starts_with("0x") || cell.starts_with("0X");
  return is_hexadecimal ? whole_text_as<std::uint32_t>(cell.substr(2), 16) : whole_text_as<std::uint32_t>(cell);
}

class TraceReader {
 public:
  TraceReader(ExportLines& lines, const RecordingOptions& options) : lines_(lines), options_(options) {
    exported_.source = lines.source();
  }

  tl::expected<ExportedColumns, InputError> read() {
    const auto take = [this](const ExportLine& line) -> TraceRead {
      if (line.is_empty()) return {};
      return line.cell(0).empty() ? add_sample(line) : take_setting(line);
    };
    if (auto taken = lines_.for_each(take); !taken) return tl::unexpected(std::move(taken.error()));
    if (auto refusal = finish()) return tl::unexpected(std::move(*refusal));
    return std::move(exported_);
  }

 private:
  TraceRead take_setting(const ExportLine& line) {
    is_in_data_ = false;
    const std::string_view key = line.cell(0);
    const std::string_view own = key_of_variable(key);
    if (key == "Flags") flags_ = flags_in(line.cell(1));
    if (own == "Variable") {
      ExportedColumn column;
      column.name = name_in_cell(line.cell(1));
      if (column.name.empty()) column.name = std::to_string(exported_.columns.size() + 1);
      column.is_kept = true;
      exported_.columns.push_back(std::move(column));
    }
    if (own == "Data") {
      if (exported_.columns.empty() || exported_.columns.back().samples > 0) {
        return tl::unexpected(without_variable(line));
      }
      is_in_data_ = true;
    }
    return {};
  }

  TraceRead add_sample(const ExportLine& line) {
    if (!is_in_data_) {
      return tl::unexpected(without_variable(line));
    }
    ExportedColumn& column = exported_.columns.back();
    constexpr std::size_t cells = 3;  // nothing, time, value
    const bool has_cells = line.cells.size() == cells || (line.cells.size() == cells + 1 && line.cells.back().empty());
    if (!has_cells && line.may_be_cut_off && line.cells.size() < cells) return leave_out(line);
    if (!has_cells) {
      return tl::unexpected(lines_.wrong_cells(line, line.cells.size(), cells, "sample"));
    }
    const NumberCell time = lines_.number(line.cells[1]);
    if (time.kind != NumberCell::Kind::number) {
      return tl::unexpected(lines_.no_number(line, 1, "time of " + column.name));
    }
    const NumberCell value = lines_.number(line.cells[2]);
    if (value.kind == NumberCell::Kind::missing && line.may_be_cut_off) return leave_out(line);
    if (value.kind == NumberCell::Kind::text && !column.unreadable) {
      column.unreadable = lines_.no_number(line, 2, column.name);
    }
    column.lines.add(column.samples++, line.line.number);
    column.times.push_back(time.value);
    column.values.push_back(value.value);
    return {};
  }

  InputError without_variable(const ExportLine& line) const {
    return lines_.refused(line, {.code = ProblemCode::line_without_header, .subjects = {{"format", "codesys"}}});
  }

  TraceRead leave_out(const ExportLine& line) {
    exported_.remarks.push_back(
        warning({.code = FindingCode::last_line_cut_off, .evidence = {counted("line", line.line.number)}}));
    return {};
  }

  /// Names the times by their unit and puts them behind the variables.
  std::optional<InputError> finish() {
    const std::size_t variables = exported_.columns.size();
    if (variables == 0) {
      return InputError{{.file = exported_.source},
                        {.code = ProblemCode::no_columns, .subjects = {{"format", "codesys"}}}};
    }
    constexpr std::uint32_t in_ms = 0x10;
    constexpr std::uint32_t in_us = 0x20;
    const std::uint32_t flags = flags_.value_or(0);
    const bool is_stated = ((flags & in_ms) != 0) != ((flags & in_us) != 0);
    if (!is_stated && !options_.columns.empty() && !options_.time_scale && !options_.rate) {
      return InputError{{.file = exported_.source, .key = "Flags"},
                        {.code = ProblemCode::no_times, .subjects = {{"of", "flags"}}}};
    }
    const std::string unit = !is_stated ? "" : (flags & in_ms) != 0 ? "ms" : "us";
    for (std::size_t c = 0; c < variables; ++c) {
      ExportedColumn& column = exported_.columns[c];
      column.time_name = with_unit("time of " + column.name, unit);
      ExportedColumn times;
      times.name = column.time_name;
      times.samples = column.samples;
      times.holds_times = true;
      times.values = column.times;
      times.lines = column.lines;
      exported_.columns.push_back(std::move(times));
    }
    Finding found{.code = FindingCode::codesys_trace, .evidence = {counted("variables", variables)}};
    if (is_stated) found.subjects.push_back({"unit", unit});
    exported_.remarks.insert(exported_.remarks.begin(), note(std::move(found)));
    return std::nullopt;
  }

  ExportLines& lines_;
  const RecordingOptions& options_;
  ExportedColumns exported_;
  std::optional<std::uint32_t> flags_;
  bool is_in_data_ = false;
};

}  // namespace

bool is_codesys_trace(std::string_view text) {
  const std::string first = lower_case(text.substr(0, std::min(text.find('\n'), text.size())));
  const std::size_t semicolon = first.find(';');
  if (semicolon == std::string::npos) return false;
  std::string_view value = std::string_view(first).substr(semicolon + 1);
  if (!value.empty() && value.back() == '\r') value.remove_suffix(1);
  return trimmed(std::string_view(first).substr(0, semicolon)) == "[key]" && trimmed(value) == "[value]";
}

tl::expected<ExportedColumns, InputError> read_codesys_trace(TextLines text, const RecordingOptions& options,
                                                             const Progress& progress) {
  ExportLines lines(std::move(text), ';', options.decimal_mark, progress);
  return TraceReader(lines, options).read();
}

}  // namespace zwidth::internal
