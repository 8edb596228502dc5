#include "io/text_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "io/codesys_trace.hpp"
#include "io/column_names.hpp"
#include "io/controldesk_export.hpp"
#include "io/exported_columns.hpp"
#include "io/labview_measurement.hpp"
#include "io/prose.hpp"
#include "io/recording_channels.hpp"
#include "io/row_lines.hpp"
#include "io/text_table.hpp"
#include "io/time_axis.hpp"
#include "io/twincat_scope.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

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
    return tl::unexpected(InputError{{.file = table.source()}, with_columns({.code = ProblemCode::no_times}, names)});
  }
  selection.time = static_cast<std::size_t>(time - names.begin());
  return selection;
}

/// The export of a measuring program, told by the words of its own header, and its reader.
struct ExportFormat {
  bool (*is_it)(std::string_view text);
  tl::expected<ExportedColumns, InputError> (*read)(TextLines lines, const RecordingOptions& options,
                                                    const Progress& progress);
};
constexpr ExportFormat export_formats[] = {{is_twincat_scope, read_twincat_scope},
                                           {is_codesys_trace, read_codesys_trace},
                                           {is_labview_measurement, read_labview_measurement},
                                           {is_controldesk_export, read_controldesk_export}};

/// The reader of the export that a text is; none where it is a table, or is to be read as one from some line on.
const ExportFormat* export_format_of(TextLines& lines, const RecordingOptions& options) {
  if (options.skip_rows > 0 || refused_as_text(lines.buffered(), "")) return nullptr;
  if (lines.buffered().starts_with(byte_order_mark)) lines.skip(byte_order_mark.size());
  const auto* const found =
      std::ranges::find_if(export_formats, [&](const ExportFormat& format) { return format.is_it(lines.buffered()); });
  return found == std::end(export_formats) ? nullptr : found;
}

}  // namespace

tl::expected<Recording, InputError> read_text_recording(TextLines lines, const RecordingOptions& options,
                                                        const Progress& progress) {
  if (const ExportFormat* const format = export_format_of(lines, options)) {
    auto exported = format->read(std::move(lines), options, progress);
    if (!exported) return tl::unexpected(std::move(exported.error()));
    return make_recording(*std::move(exported), options);
  }
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
        return tl::unexpected(table->no_number(row, indices[k], indices[k] == selection->time ? "time" : ""));
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
  if (const ExportFormat* const format = export_format_of(lines, options)) {
    const auto exported = format->read(std::move(lines), options, progress);
    if (!exported) return tl::unexpected(exported.error());
    return list_exported(*exported);
  }
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
