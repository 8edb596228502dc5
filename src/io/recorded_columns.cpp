#include "zwidth/io/recorded_columns.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "counted.hpp"
#include "io/column_names.hpp"
#include "io/column_unit.hpp"
#include "io/exported_columns.hpp"
#include "io/prose.hpp"
#include "io/raw_column.hpp"
#include "io/recording_channels.hpp"
#include "io/time_axis.hpp"

namespace zwidth {
using namespace internal;
namespace {

InputError refused(const RecordedColumns& recorded, std::string key, Problem problem) {
  return {{.file = recorded.source, .key = std::move(key)}, std::move(problem)};
}

std::vector<std::string> names_of(const RecordedColumns& recorded) {
  std::vector<std::string> names;
  for (const RecordedColumn& each : recorded.columns) names.push_back(each.name);
  return names;
}

/// The column of times: the one asked for, or the first whose name says time.
tl::expected<const RecordedColumn*, InputError> find_times(const RecordedColumns& recorded,
                                                           const RecordingOptions& options) {
  if (options.time_column) {
    const auto found = find_column(names_of(recorded), *options.time_column, recorded.source);
    if (!found) return tl::unexpected(found.error());
    return &recorded.columns[*found];
  }
  for (const RecordedColumn& each : recorded.columns) {
    if (names_a_time(each.name)) return &each;
  }
  return nullptr;
}

RawColumn raw(const RecordedColumns& recorded, const RecordedColumn& column) {
  return {recorded.source, column.name, column.samples, {}};
}

/// As those of an export whose columns have times of their own.
ExportedColumns as_exported(const RecordedColumns& recorded, const RecordingOptions& options) {
  ExportedColumns exported;
  exported.source = recorded.source;
  for (const RecordedColumn& each : recorded.columns) {
    ExportedColumn column;
    column.name = each.name;
    exported.columns.push_back(std::move(column));
  }
  mark_columns_to_keep(exported, options);
  for (std::size_t c = 0; c < exported.columns.size(); ++c) {
    ExportedColumn& column = exported.columns[c];
    const RecordedColumn& from = recorded.columns[c];
    column.samples = from.samples.size();
    column.has_lines = false;
    if (from.time_column) exported.columns[*from.time_column].holds_times = true;
    if (!column.is_kept) continue;
    column.values = from.samples;
    if (!from.time_column) continue;
    column.time_name = recorded.columns[*from.time_column].name;
    column.times = recorded.columns[*from.time_column].samples;
  }
  return exported;
}

}  // namespace

std::optional<InputError> find_problem(const RecordedColumns& recorded) {
  const auto& period = recorded.sampling_period;
  if (period && !(std::isfinite(*period) && *period > 0.0)) {
    return refused(recorded, "sampling_period",
                   {.code = ProblemCode::not_finite_and_positive,
                    .evidence = {{"value", *period}},
                    .subjects = {{"in", "s"}, {"unit", "s"}}});
  }
  if (recorded.columns.empty()) return refused(recorded, "", {.code = ProblemCode::no_columns});
  const auto holds_times = [&](const RecordedColumn& column) {
    return std::any_of(recorded.columns.begin(), recorded.columns.end(), [&](const RecordedColumn& each) {
      return each.time_column && *each.time_column < recorded.columns.size() &&
             &recorded.columns[*each.time_column] == &column;
    });
  };
  const RecordedColumn* first = nullptr;  // of those without times of their own
  for (const RecordedColumn& each : recorded.columns) {
    if (each.time_column && *each.time_column >= recorded.columns.size()) {
      return refused(recorded, shortened(each.name),
                     {.code = ProblemCode::no_column_of_times,
                      .evidence = {counted("column", *each.time_column), counted("columns", recorded.columns.size())}});
    }
    if (each.samples.size() < 2) {
      return refused(recorded, shortened(each.name),
                     {.code = ProblemCode::too_few_samples, .evidence = {counted("samples", each.samples.size())}});
    }
    if (!each.time_column && holds_times(each)) continue;
    if (!each.time_column && first == nullptr) first = &each;
    const RecordedColumn& other = each.time_column ? recorded.columns[*each.time_column] : *first;
    if (each.samples.size() == other.samples.size()) continue;
    return refused(recorded, shortened(each.name),
                   {.code = ProblemCode::samples_of_two_lengths,
                    .evidence = {counted("samples", each.samples.size()), counted("expected", other.samples.size())},
                    .subjects = {{"other", shortened(other.name)}}});
  }
  return std::nullopt;
}

tl::expected<Recording, InputError> read_recording(const RecordedColumns& recorded, const RecordingOptions& options) {
  check_recording_options(options);
  if (options.rate && options.time_column) {
    return tl::unexpected(refused(recorded, shortened(*options.time_column),
                                  {.code = ProblemCode::asked_for_beside, .subjects = {{"of", "times"}}}));
  }
  if (auto problem = find_problem(recorded)) return tl::unexpected(*std::move(problem));
  const bool have_own_times = std::any_of(recorded.columns.begin(), recorded.columns.end(),
                                          [](const RecordedColumn& each) { return each.time_column.has_value(); });
  if (have_own_times) return make_recording(as_exported(recorded, options), options);
  std::vector<RawColumn> columns;
  for (const ColumnRequest& request : options.columns) {
    const auto found = find_column(names_of(recorded), request.name, recorded.source);
    if (!found) return tl::unexpected(found.error());
    columns.push_back(raw(recorded, recorded.columns[*found]));
  }
  const auto found_times = find_times(recorded, options);
  if (!found_times) return tl::unexpected(found_times.error());
  const RecordedColumn* times = *found_times;
  const auto& period = recorded.sampling_period;
  const bool uses_times = times != nullptr && (options.rate || options.time_column || !period);
  return make_recording(std::move(columns), uses_times ? std::optional(raw(recorded, *times)) : std::nullopt, options,
                        period);
}

RecordingContents list_recording(const RecordedColumns& recorded) {
  RecordingContents contents;
  for (const RecordedColumn& each : recorded.columns) {
    contents.columns.push_back(
        {each.name, each.samples.size(), "in memory", std::string(unit_of_column(each.name).text)});
  }
  return contents;
}

}  // namespace zwidth
