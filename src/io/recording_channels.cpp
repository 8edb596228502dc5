#include "io/recording_channels.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "io/column_unit.hpp"
#include "io/prose.hpp"
#include "io/time_axis.hpp"
#include "require_valid.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/message_words.hpp"

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
    remarks.push_back({Remark::Severity::note,
                       fmt::format("{} is in {}", in_quotes(channel.name), shortened(unit.text)),
                       fmt::format("read in base units (N, N m, m, rad, A, V): times {:.6g}", unit.factor)});
  } else if (channel.quantity == StatedQuantity::other) {
    remarks.push_back({Remark::Severity::warning,
                       fmt::format("{} is used as it stands, in {}", in_quotes(channel.name), shortened(unit.text)),
                       "no unit of a force or motion that is known: results are in it",
                       "scale it to SI units; 1 says that it is"});
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
      return tl::unexpected(
          refused_sample(column, i,
                         fmt::format("is {:.6g}{}", column.values[i],
                                     scale == 1.0 ? "" : fmt::format(" with the scale {:.6g}", scale)),
                         "must be below 1e100 in magnitude, as any force and motion is; a damaged cell?"));
    }
  }
  channel.samples = std::move(column.values);
  return channel;
}

tl::expected<TimeAxis, InputError> find_axis(std::optional<RawColumn> times, const RecordingOptions& options,
                                             std::optional<double> period, const std::string& source) {
  if (options.rate) return axis_of_rate(*options.rate);
  if (times) return time_axis(std::move(*times), options);
  if (period) return axis_of_rate(1.0 / *period);
  return tl::unexpected(no_time_axis(source));
}

}  // namespace

InputError no_time_axis(const std::string& source) {
  return {source,
          0,
          0,
          "",
          "has no column whose name says time",
          "state the rate in Hz (`rate`) or the column of times (`time_column`)"};
}

void check_recording_options(const RecordingOptions& options) {
  if (options.columns.empty()) {
    throw Error(ErrorCode::invalid_argument, "no columns are asked for; name one at least");
  }
  require_valid(find_problem(options));
}

tl::expected<Recording, InputError> make_recording(std::vector<RawColumn> columns, std::optional<RawColumn> times,
                                                   const RecordingOptions& options, std::optional<double> period) {
  Recording recording;
  recording.source = columns.front().source;
  auto axis = find_axis(std::move(times), options, period, recording.source);
  if (!axis) return tl::unexpected(std::move(axis.error()));
  recording.sampling_period = axis->sampling_period;
  recording.remarks = std::move(axis->remarks);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    auto channel = make_channel(std::move(columns[i]), options.columns[i], recording.remarks);
    if (!channel) return tl::unexpected(std::move(channel.error()));
    recording.channels.push_back(std::move(*channel));
  }
  return recording;
}

}  // namespace zwidth::internal
