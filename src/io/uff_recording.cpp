#include "io/uff_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "counted.hpp"
#include "io/column_unit.hpp"
#include "io/prose.hpp"
#include "io/recording_channels.hpp"
#include "io/time_axis.hpp"
#include "io/uff_file.hpp"
#include "io/uff_names.hpp"
#include "io/uff_values.hpp"

namespace zwidth::internal {
namespace {

using Refusal = tl::unexpected<InputError>;

/// Two axes that differ by less are one; the header has six digits of the step.
constexpr double same_step = 1e-5;
constexpr double same_start = 0.01;    // of a step
constexpr double rate_differs = 1e-3;  // relative

bool is_time_record(const UffRecord& record) {
  return record.function_type == uff_time_response ||
         (record.function_type == uff_unknown_function && record.abscissa.quantity == uff_time);
}

/// A record that was asked for, and its numbers.
struct Series {
  const UffRecord* record = nullptr;
  std::string name;
  UffValues values;
};

tl::expected<Series, InputError> read_series(const UffFile& file, const std::string& asked) {
  const auto index = find_uff_record(file, asked);
  if (!index) return Refusal(index.error());
  const UffRecord& record = file.records[*index];
  if (!is_time_record(record) || record.is_complex) {
    return Refusal(wrong_record(file, record, asked, "times"));
  }
  auto values = read_uff_values(file, record);
  if (!values) return Refusal(std::move(values.error()));
  return Series{&record, uff_names(file)[*index], std::move(*values)};
}

double seconds_per_unit(const UffRecord& record, const RecordingOptions& options) {
  return options.time_scale.value_or(seconds_per(record.abscissa.unit).value_or(1.0));
}

InputError refused(const UffFile& file, const Series& series, Problem problem) {
  return {{.file = file.source, .line = series.record->line, .column = 1, .key = shortened(series.name)},
          std::move(problem)};
}

/// Records of one recording have as many samples.
tl::expected<void, InputError> check_size(const UffFile& file, const Series& series, const Series& first) {
  const std::size_t samples = series.values.ordinate.size();
  const std::size_t expected = first.values.ordinate.size();
  if (samples == expected) return {};
  return Refusal(refused(file, series,
                         {.code = ProblemCode::samples_of_two_lengths,
                          .evidence = {counted("samples", samples), counted("expected", expected)},
                          .subjects = {{"other", shortened(first.name)}}}));
}

/// Records of one recording have their samples at the same times.
tl::expected<void, InputError> check_axes(const UffFile& file, const std::vector<Series>& all) {
  const UffRecord& first = *all.front().record;
  for (const Series& series : all) {
    const UffRecord& record = *series.record;
    if (auto checked = check_size(file, series, all.front()); !checked) return checked;
    const bool same = record.is_even == first.is_even &&
                      (record.is_even ? std::abs(record.step - first.step) <= same_step * first.step &&
                                            std::abs(record.first - first.first) <= same_start * first.step
                                      : series.values.abscissa == all.front().values.abscissa);
    if (!same || record.abscissa.unit != first.abscissa.unit) {
      return Refusal(refused(
          file, series,
          {.code = ProblemCode::axes_differ, .subjects = {{"axis", "times"}, {"other", shortened(all.front().name)}}}));
    }
  }
  return {};
}

/// The axis of times of uneven records, or the times in a record of its own.
tl::expected<std::optional<RawColumn>, InputError> find_times(const UffFile& file, const RecordingOptions& options,
                                                              const Series& first) {
  if (options.rate) return std::nullopt;
  if (options.time_column) {
    auto times = read_series(file, *options.time_column);
    if (!times) return Refusal(std::move(times.error()));
    if (auto checked = check_size(file, *times, first); !checked) return Refusal(std::move(checked.error()));
    return RawColumn{file.source, times->name, std::move(times->values.ordinate), {}};
  }
  if (first.record->is_even) return std::nullopt;
  const UffAxis& axis = first.record->abscissa;
  const std::string name = fmt::format("time [{}]", axis.unit.empty() ? "s" : axis.unit);
  return RawColumn{file.source, name, first.values.abscissa, {}};
}

/// What the file states and the user overrides, or what an even axis says.
void remark_on_axis(const UffRecord& record, const RecordingOptions& options, double period, Recording& recording) {
  if (!record.is_even || options.time_column) return;
  if (!options.rate) {
    recording.remarks.push_back(note({.code = FindingCode::rate_of_file, .evidence = {{"rate", 1.0 / period}}}));
  } else if (std::abs(*options.rate * period - 1.0) > rate_differs) {
    add_contradiction({.code = FindingCode::rate_contradicts_file,
                       .evidence = {{"given", *options.rate}, {"stated", 1.0 / period}, {"threshold", rate_differs}}},
                      recording);
  }
}

}  // namespace

tl::expected<Recording, InputError> read_uff_recording(const std::string& path, const RecordingOptions& options,
                                                       const Progress& progress) {
  check_recording_options(options);
  const auto file = read_uff_file(path, progress);
  if (!file) return Refusal(file.error());
  std::vector<Series> all;
  for (const ColumnRequest& request : options.columns) {
    auto series = read_series(*file, request.name);
    if (!series) return Refusal(std::move(series.error()));
    all.push_back(std::move(*series));
  }
  if (auto checked = check_axes(*file, all); !checked) return Refusal(std::move(checked.error()));
  auto times = find_times(*file, options, all.front());
  if (!times) return Refusal(std::move(times.error()));

  const UffRecord& first = *all.front().record;
  const double period = first.step * seconds_per_unit(first, options);
  std::vector<RawColumn> columns;
  std::vector<Remark> remarks = file->remarks;
  for (Series& series : all) {
    columns.push_back({file->source, series.name, std::move(series.values.ordinate), {}});
    remarks.insert(remarks.end(), series.values.remarks.begin(), series.values.remarks.end());
  }
  auto recording = make_recording(std::move(columns), std::move(*times), options, period);
  if (!recording) return recording;
  remark_on_axis(first, options, period, *recording);
  recording->remarks.insert(recording->remarks.end(), remarks.begin(), remarks.end());
  return recording;
}

tl::expected<RecordingContents, InputError> list_uff_recording(const std::string& path,
                                                               const RecordingOptions& /*options*/,
                                                               const Progress& progress) {
  const auto file = read_uff_file(path, progress);
  if (!file) return Refusal(file.error());
  RecordingContents contents{RecordingFormat::uff, {}, file->remarks};
  const auto names = uff_names(*file);
  for (std::size_t i = 0; i < names.size(); ++i) {
    contents.columns.push_back({names[i], file->records[i].points, uff_description(file->records[i])});
  }
  return contents;
}

}  // namespace zwidth::internal
