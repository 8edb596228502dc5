#include "io/exported_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <utility>

#include "counted.hpp"
#include "io/column_names.hpp"
#include "io/paired_times.hpp"
#include "io/prose.hpp"
#include "io/recording_channels.hpp"
#include "io/time_axis.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

using Refusal = tl::unexpected<InputError>;

std::vector<std::string> names_in(const ExportedColumns& exported) {
  std::vector<std::string> names;
  for (const ExportedColumn& column : exported.columns) names.push_back(column.name);
  return names;
}

/// The column and its times; a column of times is its own.
tl::expected<TimedColumn, InputError> timed_column(const ExportedColumns& exported, const std::string& asked) {
  const auto found = find_column(names_in(exported), asked, exported.source);
  if (!found) return Refusal(found.error());
  const ExportedColumn& column = exported.columns[*found];
  if (column.unreadable) return Refusal(*column.unreadable);
  if (column.values.empty()) {
    return Refusal(InputError{{.file = exported.source, .key = shortened(column.name)},
                              {.code = ProblemCode::too_few_samples, .evidence = {counted("samples", 0)}}});
  }
  std::function<std::size_t(std::size_t)> line;
  if (column.has_lines) {
    line = [lines = std::make_shared<RowLines>(column.lines)](std::size_t row) { return lines->line_of(row); };
  }
  return TimedColumn{{exported.source, column.name, column.values, line},
                     {exported.source, column.holds_times ? column.name : column.time_name,
                      column.holds_times ? column.values : column.times, line}};
}

/// Columns without times must have equally many rows.
std::optional<InputError> different_lengths(const std::vector<TimedColumn>& columns) {
  const TimedColumn& first = columns.front();
  for (const TimedColumn& each : columns) {
    if (each.values.values.size() == first.values.values.size()) continue;
    return InputError{
        {.file = each.values.source, .key = shortened(each.values.name)},
        {.code = ProblemCode::samples_of_two_lengths,
         .evidence = {counted("samples", each.values.values.size()), counted("expected", first.values.values.size())},
         .subjects = {{"other", shortened(first.values.name)}}}};
  }
  return std::nullopt;
}

/// A header states a scale and does not say whether it is applied: what is asked for explicitly settles it.
void judge_scale(const ExportedColumn& column, const ColumnRequest& request, Recording& recording) {
  const auto& [factor, offset] = column.scale;
  if (factor == 1.0 && offset == 0.0) return;
  Finding found{.code = FindingCode::stated_scale_unclear,
                .evidence = {{"factor", factor}, {"offset", offset}},
                .subjects = {{"column", in_quotes(column.name)}}};
  if (factor == 1.0 || request.scale) {
    found.code = factor == 1.0 ? FindingCode::stated_offset_unused : FindingCode::stated_scale_unused;
    recording.remarks.push_back(note(std::move(found)));
    return;
  }
  recording.doubts.push_back(found);
  recording.remarks.push_back(warning(std::move(found)));
}

}  // namespace

void mark_columns_to_keep(ExportedColumns& exported, const RecordingOptions& options) {
  const auto names = names_in(exported);
  const auto keep = [&](const std::string& asked) {
    if (const auto found = find_column(names, asked, exported.source)) exported.columns[*found].is_kept = true;
  };
  for (const ColumnRequest& request : options.columns) keep(request.name);
  if (options.time_column) keep(*options.time_column);
}

tl::expected<Recording, InputError> make_recording(ExportedColumns exported, const RecordingOptions& options) {
  std::vector<TimedColumn> timed;
  for (const ColumnRequest& request : options.columns) {
    auto column = timed_column(exported, request.name);
    if (!column) return Refusal(std::move(column.error()));
    timed.push_back(std::move(*column));
  }
  if (options.time_column) {
    auto column = timed_column(exported, *options.time_column);
    if (!column) return Refusal(std::move(column.error()));
    timed.push_back(std::move(*column));
  }
  const bool have_times =
      std::ranges::none_of(timed, [](const TimedColumn& column) { return column.times.values.empty(); });
  std::vector<Remark> cut;
  if (have_times) {
    auto kept = keep_common_rows(timed, options);
    if (!kept) return Refusal(std::move(kept.error()));
    cut = std::move(*kept);
  } else if (auto refusal = different_lengths(timed)) {
    return Refusal(std::move(*refusal));
  }

  std::optional<RawColumn> times;
  if (options.time_column) {
    times = std::move(timed.back().values);
    timed.pop_back();
  } else if (have_times) {  // beside a rate too: they tell lost rows
    times = std::move(timed.front().times);
  }
  std::vector<RawColumn> columns;
  for (TimedColumn& column : timed) columns.push_back(std::move(column.values));
  auto recording = make_recording(std::move(columns), std::move(times), options);
  if (!recording) return recording;

  auto& remarks = recording->remarks;
  remarks.insert(remarks.begin(), exported.remarks.begin(), exported.remarks.end());
  remarks.insert(remarks.end(), cut.begin(), cut.end());
  const auto names = names_in(exported);
  for (const ColumnRequest& request : options.columns) {
    const auto found = find_column(names, request.name, exported.source);
    judge_scale(exported.columns[*found], request, *recording);
  }
  for (Finding& doubt : exported.doubts) {
    if (options.rate) {
      doubt.evidence.push_back({"rate", *options.rate});
      remarks.push_back(note(doubt));
    } else {
      add_contradiction(doubt, *recording);
    }
  }
  return recording;
}

RecordingContents list_exported(const ExportedColumns& exported) {
  RecordingContents contents;
  contents.remarks = exported.remarks;
  for (const ExportedColumn& column : exported.columns) {
    std::string detail = column.holds_times         ? "times"
                         : column.time_name.empty() ? "numbers"
                                                    : fmt::format("numbers, {}", in_quotes(column.time_name));
    contents.columns.push_back({column.name, column.samples, std::move(detail)});
  }
  return contents;
}

}  // namespace zwidth::internal
