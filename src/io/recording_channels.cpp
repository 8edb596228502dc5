#include "io/recording_channels.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>

#include "counted.hpp"
#include "io/column_unit.hpp"
#include "io/prose.hpp"
#include "io/time_axis.hpp"
#include "signal/restored_rows.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/message_words.hpp"
#include "zwidth/require_valid.hpp"

namespace zwidth::internal {
namespace {

/// What a column's values are multiplied by: the scale asked for, else (or where that is 1, or turns the sign) that of the
/// unit in its name, which is said. The channel states that unit where no scale was asked for.
double scale_of(const ColumnRequest& request, Channel& channel, std::vector<Remark>& remarks) {
  const double asked = request.scale.value_or(1.0);
  const ColumnUnit unit = unit_of_column(channel.name);
  if (std::abs(asked) != 1.0) {  // that of the name's unit: then its quantity is the name's too
    constexpr double close = 1e-3;
    if (std::abs(std::abs(asked) - unit.factor) < close * unit.factor) channel.base_unit = unit.base;
    return asked;
  }
  if (unit.text.empty()) return asked;
  channel.base_unit = unit.base;
  if (!request.scale || *request.scale != 1.0) {
    channel.unit = unit.text;
    channel.quantity = unit.quantity;
  }
  if (unit.factor != 1.0) {
    remarks.push_back(note({.code = FindingCode::column_scaled_by_its_unit,
                            .evidence = {{"factor", unit.factor}},
                            .subjects = {{"column", in_quotes(channel.name)}, {"unit", shortened(unit.text)}}}));
  } else if (channel.quantity == StatedQuantity::other) {
    remarks.push_back(warning({.code = FindingCode::column_unit_unknown,
                               .subjects = {{"column", in_quotes(channel.name)}, {"unit", shortened(unit.text)}}}));
  }
  return asked * unit.factor;
}

tl::expected<Channel, InputError> make_channel(RawColumn column, const ColumnRequest& request,
                                               std::vector<Remark>& remarks) {
  if (auto filled = fill_missing(column, remarks); !filled) return tl::unexpected(std::move(filled.error()));
  Channel channel{.name = column.name, .samples = {}};
  const double scale = scale_of(request, channel, remarks);
  for (std::size_t i = 0; i < column.values.size(); ++i) {
    column.values[i] *= scale;
    constexpr double largest = 1e100;  // squares of more, summed, are no numbers
    if (!(std::abs(column.values[i]) < largest)) {
      Problem problem{.code = ProblemCode::sample_too_large, .evidence = {{"value", column.values[i]}}};
      if (scale != 1.0) problem.evidence.push_back({"scale", scale});
      return tl::unexpected(refused_sample(column, i, std::move(problem)));
    }
  }
  channel.samples = std::move(column.values);
  return channel;
}

tl::expected<std::vector<Channel>, InputError> make_channels(std::vector<RawColumn> columns,
                                                             const RecordingOptions& options,
                                                             std::vector<Remark>& remarks) {
  std::vector<Channel> channels;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    auto channel = make_channel(std::move(columns[i]), options.columns[i], remarks);
    if (!channel) return tl::unexpected(std::move(channel.error()));
    channels.push_back(std::move(*channel));
  }
  return channels;
}

/// Leaves out rows that say again what the row before says, times included.
void leave_out_repeated(std::vector<Channel>& channels, RawColumn& times, std::vector<Remark>& remarks) {
  std::vector<std::size_t> kept;
  std::optional<std::size_t> first;
  const std::size_t rows = times.values.size();
  for (std::size_t i = 0; i < rows; ++i) {
    const bool repeats =
        i > 0 && times.values[i] == times.values[i - 1] &&
        std::ranges::all_of(channels, [i](const Channel& each) { return each.samples[i] == each.samples[i - 1]; });
    if (!repeats) kept.push_back(i);
    if (repeats && !first) first = i;
  }
  if (!first || kept.size() < 2) return;
  const std::size_t repeated = rows - kept.size();
  remarks.push_back(warning({.code = FindingCode::rows_repeated,
                             .evidence = {counted("repeated", repeated),
                                          counted("rows", rows),
                                          {"share", static_cast<double>(repeated) / static_cast<double>(rows)}},
                             .subjects = {{"place", place_of(times, *first)}}}));
  const auto keep = [&kept](std::vector<double>& values) {
    for (std::size_t k = 0; k < kept.size(); ++k) values[k] = values[kept[k]];
    values.resize(kept.size());
  };
  for (Channel& each : channels) keep(each.samples);
  keep(times.values);
  if (times.line) times.line = [line = times.line, kept](std::size_t sample) { return line(kept[sample]); };
}

/// Equal steps, with what was found. Refused where the stretches between gaps are too short.
tl::expected<void, InputError> restore(const TimeAxis& axis, Recording& recording) {
  std::vector<std::span<const double>> signals;
  for (const Channel& each : recording.channels) signals.emplace_back(each.samples);
  const std::size_t all = axis.column.values.size();
  RestoredRows rows = restored_rows(axis.column.values, axis.grid, signals);
  constexpr double least_used = 0.1;
  if (static_cast<double>(rows.used_rows) < least_used * static_cast<double>(all)) {
    return tl::unexpected(
        refused_sample(axis.column, rows.first_gap + 1,
                       {.code = ProblemCode::too_many_rows_lost,
                        .evidence = {counted("lost", rows.lost), counted("rows", axis.grid.slots.back() + 1),
                                     counted("used", rows.used_rows)}}));
  }
  recording.sampling_period = rows.period;
  for (std::size_t i = 0; i < recording.channels.size(); ++i) {
    recording.channels[i].samples = std::move(rows.signals[i]);
  }
  add_row_findings(axis, rows, recording);
  return {};
}

}  // namespace

void check_recording_options(const RecordingOptions& options) {
  if (options.columns.empty()) {
    throw Error(ErrorCode::invalid_argument, {.code = ProblemCode::no_columns, .evidence = {counted("asked", 0)}});
  }
  require_valid(find_problem(options));
}

tl::expected<Recording, InputError> make_recording(std::vector<RawColumn> columns, std::optional<RawColumn> times,
                                                   const RecordingOptions& options, std::optional<double> period) {
  Recording recording;
  recording.source = columns.front().source;
  if (options.rate) recording.sampling_period = period_of_rate(*options.rate);
  if (!options.rate && !times && period) recording.sampling_period = period_of_rate(1.0 / *period);
  if (!options.rate && !times && !period) {
    return tl::unexpected(InputError{{.file = recording.source}, {.code = ProblemCode::no_times}});
  }
  std::vector<Remark> remarks;
  auto channels = make_channels(std::move(columns), options, remarks);
  if (!channels) return tl::unexpected(std::move(channels.error()));
  recording.channels = std::move(*channels);
  if (times) {
    leave_out_repeated(recording.channels, *times, remarks);
    auto axis = time_axis(std::move(*times), options);
    if (!axis && !options.rate) return tl::unexpected(std::move(axis.error()));
    if (axis) {
      if (!options.rate) recording.remarks = axis->remarks;
      const auto contradicting = options.rate ? contradiction(*options.rate, *axis, options) : std::nullopt;
      if (const auto restored = restore(*axis, recording); !restored) return tl::unexpected(restored.error());
      if (options.rate) recording.sampling_period = period_of_rate(*options.rate);
      if (contradicting) add_contradiction(*contradicting, recording);
    }
  }
  recording.remarks.insert(recording.remarks.end(), remarks.begin(), remarks.end());
  return recording;
}

}  // namespace zwidth::internal
