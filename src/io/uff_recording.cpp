#include "io/uff_recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

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

InputError refused(const UffFile& file, const UffRecord& record, const std::string& asked, std::string what,
                   std::string allowed) {
  return {file.source, record.line, 1, shortened(asked), std::move(what), std::move(allowed)};
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
    return Refusal(refused(file, record, asked, fmt::format("is a {}", uff_description(record)),
                           "must be a real time record (function type 1)"));
  }
  auto values = read_uff_values(file, record);
  if (!values) return Refusal(std::move(values.error()));
  return Series{&record, uff_names(file)[*index], std::move(*values)};
}

double seconds_per_unit(const UffRecord& record, const RecordingOptions& options) {
  return options.time_scale.value_or(seconds_per(record.abscissa.unit).value_or(1.0));
}

/// Records of one recording have their samples at the same times.
tl::expected<void, InputError> check_axes(const UffFile& file, const std::vector<Series>& all) {
  const UffRecord& first = *all.front().record;
  for (const Series& series : all) {
    const UffRecord& record = *series.record;
    if (series.values.ordinate.size() != all.front().values.ordinate.size()) {
      return Refusal(refused(file, record, series.name,
                             fmt::format("has {} samples, {} has {}", series.values.ordinate.size(),
                                         shortened(all.front().name), all.front().values.ordinate.size()),
                             "records of one recording must have equally many"));
    }
    const bool same = record.is_even == first.is_even &&
                      (record.is_even ? std::abs(record.step - first.step) <= same_step * first.step &&
                                            std::abs(record.first - first.first) <= same_start * first.step
                                      : series.values.abscissa == all.front().values.abscissa);
    if (!same || record.abscissa.unit != first.abscissa.unit) {
      return Refusal(refused(file, record, series.name,
                             fmt::format("has other times than {}", shortened(all.front().name)),
                             "records of one recording must share their times"));
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
    if (times->values.ordinate.size() != first.values.ordinate.size()) {
      return Refusal(refused(file, *times->record, times->name,
                             fmt::format("has {} samples, {} has {}", times->values.ordinate.size(),
                                         shortened(first.name), first.values.ordinate.size()),
                             "records of one recording must have equally many"));
    }
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
