#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "io/raw_column.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// The uniform time axis that a column of times stands for.
struct TimeAxis {
  double sampling_period = 0.0;  ///< s
  std::vector<Remark> remarks;   ///< the rate, and where the times leave the uniform axis
};

/// Checks a column of times and finds its sampling period.
///
/// Times are unwrapped where `options.timer_bits` says so and scaled by time_scale_of(). The sampling period is the
/// mean over all periods that are no gaps (a gap: 1.5 times the median period or more, and not made up by its
/// neighbours). Jitter of more than 1 % and gaps are remarked. Refused with their place: times that fall back or stand
/// still, a count that the timer cannot show, fewer than two samples, more than 1 % of missing times.
[[nodiscard]] tl::expected<TimeAxis, InputError> time_axis(RawColumn times, const RecordingOptions& options);

/// Seconds per unit of the column: `options.time_scale`; where that is absent, what the unit in the column's name says
/// ("t [ms]", "time_us", "Time (s)"), else 1.
[[nodiscard]] double time_scale_of(const std::string& column, const RecordingOptions& options);

/// Whether a column's name says that it holds times: t, time, timestamp, seconds, ... with or without a unit.
[[nodiscard]] bool names_a_time(const std::string& column);

/// The axis of `options.rate` (Hz).
[[nodiscard]] TimeAxis axis_of_rate(double rate);

/// The ends of a column of times that is not used, since a rate is given.
struct UnusedTimes {
  std::string column;  ///< its name
  double first = 0.0;  ///< in the column's unit
  double last = 0.0;
  std::size_t samples = 0;
};

/// A warning where those times say another rate (Hz) than the one given, by more than 1 %. None where they fall back,
/// as a timer that wraps, and where they agree in ms, us or ns and their unit is not known.
[[nodiscard]] std::optional<Remark> contradiction(double rate, const UnusedTimes& times,
                                                  const RecordingOptions& options);

/// Among the recording's remarks and doubts.
void add_contradiction(const Remark& remark, Recording& recording);

}  // namespace zwidth::internal
