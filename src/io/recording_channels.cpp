#include "io/recording_channels.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "io/column_names.hpp"
#include "io/column_unit.hpp"
#include "io/prose.hpp"
#include "io/time_axis.hpp"
#include "require_valid.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/message_words.hpp"

namespace zwidth::internal {
namespace {

/// What a column's values are multiplied by: the scale asked for, else (or where that only turns the sign) that of the
/// unit in its name, which is said.
double scale_of(const RawColumn& column, const ColumnRequest& request, std::vector<Remark>& remarks) {
  const auto [name, in_brackets] = name_and_unit(column.name);
  const std::string_view unit = in_brackets.empty() ? unit_at_end(name) : in_brackets;
  const auto scale = base_units_per(unit);
  if (!scale || std::abs(request.scale) != 1.0) return request.scale;
  if (unit == "g") {  // of acceleration, or grams: only the user knows
    remarks.push_back({Remark::Severity::warning, fmt::format("{} is used as it stands, in g", in_quotes(column.name)),
                       fmt::format("results are in that unit; for m/s^2 scale the column by {:.6g}", *scale)});
    return request.scale;
  }
  remarks.push_back({Remark::Severity::note, fmt::format("{} is in {}", in_quotes(column.name), shortened(unit)),
                     fmt::format("read in base units (N, N m, m, rad, A, V): times {:.6g}", *scale)});
  return request.scale * *scale;
}

tl::expected<Channel, InputError> make_channel(RawColumn column, const ColumnRequest& request,
                                               std::vector<Remark>& remarks) {
  if (auto filled = fill_missing(column, remarks); !filled) return tl::unexpected(std::move(filled.error()));
  const double scale = scale_of(column, request, remarks);
  for (std::size_t i = 0; i < column.values.size(); ++i) {
    column.values[i] *= scale;
    if (!std::isfinite(column.values[i])) {
      return tl::unexpected(refused_sample(column, i, fmt::format("is too large for the scale {:.6g}", scale),
                                           "must be below 1e308 after scaling"));
    }
  }
  return Channel{std::move(column.name), std::move(column.values)};
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
