#include "io/text_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "io/column_names.hpp"
#include "io/prose.hpp"
#include "io/recording_channels.hpp"
#include "io/text_table.hpp"
#include "io/time_axis.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

/// The lines of rows, kept as the few places where comments or empty lines come between two rows.
class RowLines {
 public:
  void add(std::size_t row, std::size_t line) {
    if (line == row + offset_) return;
    offset_ = line - row;
    starts_.push_back({row, offset_});
  }
  [[nodiscard]] std::size_t line_of(std::size_t row) const {
    const auto after = std::upper_bound(starts_.begin(), starts_.end(), row,
                                        [](std::size_t value, const Start& start) { return value < start.row; });
    return row + (after == starts_.begin() ? 0 : std::prev(after)->offset);
  }

 private:
  struct Start {
    std::size_t row;
    std::size_t offset;  ///< from a row (from 0) to its line, from this row on
  };
  std::vector<Start> starts_;
  std::size_t offset_ = 0;
};

/// Which columns of the table are read: those asked for and, where the time axis needs it, that of the times.
struct Selection {
  std::vector<std::size_t> asked;  ///< one per request
  std::optional<std::size_t> time;
  bool may_lack_times = false;  ///< beside a given rate: then a time that is no number is no error
};

tl::expected<Selection, InputError> select_columns(const TextTable& table, const RecordingOptions& options) {
  const auto names = table.names();
  Selection selection;
  for (const ColumnRequest& request : options.columns) {
    const auto column = find_column(names, request.name, table.source());
    if (!column) return tl::unexpected(column.error());
    selection.asked.push_back(*column);
  }
  if (options.time_column) {
    const auto column = find_column(names, *options.time_column, table.source());
    if (!column) return tl::unexpected(column.error());
    selection.time = *column;
    return selection;
  }
  const auto time = std::find_if(names.begin(), names.end(), names_a_time);
  if (options.rate) {
    if (time != names.end()) selection.time = static_cast<std::size_t>(time - names.begin());
    selection.may_lack_times = true;
    return selection;
  }
  if (time == names.end()) {
    InputError refusal = no_time_axis(table.source());
    refusal.allowed += fmt::format("; the file has {}", listed_columns(names));
    return tl::unexpected(std::move(refusal));
  }
  selection.time = static_cast<std::size_t>(time - names.begin());
  return selection;
}

/// A time that is no number has its own remedy.
InputError no_time(InputError refusal) {
  refusal.allowed = "times must be numbers, such as seconds from the start; or state the rate instead (`rate`)";
  return refusal;
}

}  // namespace

tl::expected<Recording, InputError> read_text_recording(TextLines lines, const RecordingOptions& options,
                                                        const Progress& progress) {
  auto table = TextTable::open(std::move(lines), options);
  if (!table) return tl::unexpected(std::move(table.error()));
  const auto selection = select_columns(*table, options);
  if (!selection) return tl::unexpected(selection.error());

  std::vector<std::size_t> indices = selection->asked;
  if (selection->time) indices.push_back(*selection->time);
  const auto row_lines = std::make_shared<RowLines>();
  const auto names = table->names();
  std::vector<RawColumn> columns;
  for (const std::size_t index : indices) {
    columns.push_back(
        {table->source(), names[index], {}, [row_lines](std::size_t row) { return row_lines->line_of(row); }});
    columns.back().values.reserve(table->likely_rows());
  }

  const auto add_row = [&](const TextRow& row) -> tl::expected<void, InputError> {
    row_lines->add(columns.front().values.size(), row.line.number);
    for (std::size_t k = 0; k < indices.size(); ++k) {
      const NumberCell number = table->number(row.cells[indices[k]]);
      const bool may_be_text = selection->may_lack_times && indices[k] == selection->time && k + 1 == indices.size();
      if (number.kind == NumberCell::Kind::text && !may_be_text) {
        InputError refusal = table->no_number(row, indices[k]);
        return tl::unexpected(indices[k] == selection->time ? no_time(std::move(refusal)) : std::move(refusal));
      }
      columns[k].values.push_back(number.value);
    }
    return {};
  };
  if (auto read = table->each_row(add_row, progress); !read) return tl::unexpected(std::move(read.error()));

  std::optional<RawColumn> times;
  if (selection->time) {
    times = std::move(columns.back());
    columns.pop_back();
  }
  auto recording = make_recording(std::move(columns), std::move(times), options);
  if (recording) {
    recording->remarks.insert(recording->remarks.begin(), table->remarks().begin(), table->remarks().end());
  }
  return recording;
}

tl::expected<RecordingContents, InputError> list_text_recording(TextLines lines, const RecordingOptions& options,
                                                                const Progress& progress) {
  auto table = TextTable::open(std::move(lines), options);
  if (!table) return tl::unexpected(std::move(table.error()));
  std::size_t rows = 0;
  std::vector<std::string> details(table->columns());
  const auto count = [&](const TextRow& row) -> tl::expected<void, InputError> {
    if (rows++ > 0) return {};
    for (std::size_t c = 0; c < table->columns(); ++c) {
      const bool is_text = table->number(row.cells[c]).kind == NumberCell::Kind::text;
      details[c] = is_text ? fmt::format("text: {}", in_quotes(without_controls(as_utf8(row.cells[c])))) : "numbers";
    }
    return {};
  };
  if (auto counted = table->each_row(count, progress); !counted) return tl::unexpected(std::move(counted.error()));
  RecordingContents contents;
  contents.remarks = table->remarks();
  const auto names = table->names();
  for (std::size_t c = 0; c < names.size(); ++c) contents.columns.push_back({names[c], rows, details[c]});
  return contents;
}

}  // namespace zwidth::internal
