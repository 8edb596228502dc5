#include "zwidth/io/recorded_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "io/column_names.hpp"
#include "io/prose.hpp"
#include "io/raw_column.hpp"
#include "io/recording_channels.hpp"
#include "io/time_axis.hpp"

namespace zwidth {
using namespace internal;
namespace {

InputError refused(const RecordedColumns& recorded, std::string key, std::string what, std::string allowed) {
  return {recorded.source, 0, 0, std::move(key), std::move(what), std::move(allowed)};
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

}  // namespace

std::optional<InputError> find_problem(const RecordedColumns& recorded) {
  const auto& period = recorded.sampling_period;
  if (period && !(std::isfinite(*period) && *period > 0.0)) {
    return refused(recorded, "sampling_period", fmt::format("is {} s", *period), "must be above 0");
  }
  if (recorded.columns.empty()) return refused(recorded, "", "has no columns", "must have one at least");
  const std::size_t count = recorded.columns.size();
  for (const RecordedColumn& each : recorded.columns) {
    if (!each.times || (*each.times < count && recorded.columns[*each.times].samples.size() == each.samples.size()))
      continue;
    return refused(recorded, shortened(each.name), "has no times, or other than as many",
                   "its times must be a column of as many samples");
  }
  const auto has_own = [&recorded](const RecordedColumn& column) {
    return column.times || std::ranges::any_of(recorded.columns, [&](const RecordedColumn& each) {
             return each.times && &recorded.columns[*each.times] == &column;
           });
  };
  const auto shares = std::ranges::find_if_not(recorded.columns, has_own);
  const RecordedColumn& first = shares == recorded.columns.end() ? recorded.columns.front() : *shares;
  for (const RecordedColumn& each : recorded.columns) {
    if (has_own(each) && each.samples.size() >= 2) continue;
    if (each.samples.size() == first.samples.size()) continue;
    return refused(
        recorded, shortened(each.name),
        fmt::format("has {} samples, {} has {}", each.samples.size(), shortened(first.name), first.samples.size()),
        "signals of one recording must have equally many");
  }
  if (first.samples.size() >= 2) return std::nullopt;
  return refused(recorded, shortened(first.name), fmt::format("has {} samples", first.samples.size()),
                 "must have two at least");
}

tl::expected<Recording, InputError> read_recording(const RecordedColumns& recorded, const RecordingOptions& options) {
  check_recording_options(options);
  if (options.rate && options.time_column) {
    return tl::unexpected(refused(recorded, shortened(*options.time_column),
                                  "a column of times is asked for beside a rate", "must be one of the two"));
  }
  if (auto problem = find_problem(recorded)) return tl::unexpected(*std::move(problem));
  std::vector<const RecordedColumn*> asked;
  for (const ColumnRequest& request : options.columns) {
    const auto found = find_column(names_of(recorded), request.name, recorded.source);
    if (!found) return tl::unexpected(found.error());
    asked.push_back(&recorded.columns[*found]);
  }
  const auto has_own_times = [](const RecordedColumn* column) { return column->times.has_value(); };
  const auto times_of = [&recorded](const RecordedColumn* column) {
    return column->times ? &recorded.columns[*column->times] : nullptr;
  };
  const RecordedColumn* common = times_of(asked.front());  // times of all
  const bool has_common = common != nullptr && std::ranges::all_of(asked, [&](const RecordedColumn* each) {
                            return times_of(each) != nullptr && times_of(each)->samples == common->samples;
                          });
  if (std::ranges::any_of(asked, has_own_times) && !has_common && !options.rate && !options.time_column) {
    std::vector<TimedColumn> timed;
    for (const RecordedColumn* each : asked) {
      if (!each->times) {
        return tl::unexpected(refused(recorded, shortened(each->name), "has no times of its own beside one that has",
                                      "all columns asked for must have their times, or none"));
      }
      timed.push_back({raw(recorded, *each), raw(recorded, recorded.columns[*each->times])});
    }
    return make_recording(std::move(timed), options);
  }
  std::vector<RawColumn> columns;
  for (const RecordedColumn* each : asked) {
    columns.push_back(raw(recorded, *each));
    if (columns.back().values.size() == columns.front().values.size()) continue;
    return tl::unexpected(refused(recorded, shortened(each->name),
                                  fmt::format("has {} samples, {} has {}", columns.back().values.size(),
                                              shortened(columns.front().name), columns.front().values.size()),
                                  "without their times, signals must have equally many"));
  }
  const auto found_times = find_times(recorded, options);
  if (!found_times) return tl::unexpected(found_times.error());
  const RecordedColumn* times = has_common && !options.time_column ? common : *found_times;
  const auto& period = recorded.sampling_period;
  const bool uses_times = times != nullptr && times->samples.size() == columns.front().values.size() &&
                          (has_common || options.rate || options.time_column || !period);
  auto recording = make_recording(std::move(columns), uses_times ? std::optional(raw(recorded, *times)) : std::nullopt,
                                  options, period);
  return recording;
}

RecordingContents list_recording(const RecordedColumns& recorded) {
  RecordingContents contents;
  for (const RecordedColumn& each : recorded.columns) {
    contents.columns.push_back({each.name, each.samples.size(), "in memory"});
  }
  return contents;
}

}  // namespace zwidth
