#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "io/raw_column.hpp"
#include "signal/restored_rows.hpp"
#include "signal/row_grid.hpp"
#include "zwidth/io/recording_file.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth::internal {

/// A column of times, as far as it can be told without the signals.
struct TimeAxis {
  double sampling_period = 0.0;  ///< s; that of the grid
  std::vector<Remark> remarks;   ///< the rate
  RawColumn column = {};         ///< checked, in s
  RowGrid grid = {};             ///< which row is which step of it
};

/// Checks a column of times and finds the grid that its rows lie on (row_grid()).
///
/// Times are unwrapped where `options.timer_bits` says so and scaled by time_scale_of(). Refused with their place: times
/// that fall back or stand still, a count that the timer cannot show, fewer than two samples, more than 1 % of missing
/// times.
[[nodiscard]] tl::expected<TimeAxis, InputError> time_axis(RawColumn times, const RecordingOptions& options);

/// What was found of lost rows and of jitter, among the recording's remarks and doubts.
void add_row_findings(const TimeAxis& axis, const RestoredRows& rows, Recording& recording);

/// Seconds per unit of the column: `options.time_scale`; where that is absent, what the unit in the column's name says
/// ("t [ms]", "time_us", "Time (s)"), else 1.
[[nodiscard]] double time_scale_of(const std::string& column, const RecordingOptions& options);

/// Whether a column's name says that it holds times: t, time, timestamp, seconds, ... with or without a unit.
[[nodiscard]] bool names_a_time(const std::string& column);

/// The problem of an option that must be above 0, in its unit.
[[nodiscard]] OptionProblem not_above_zero(std::string member, double value, const std::string& unit);

/// s, of a rate in Hz.
[[nodiscard]] double period_of_rate(double rate);

/// A warning where the times say another rate (Hz) than the one given, by more than 0.1 % (and one row). None where they
/// agree in ms, us or ns and their unit is not known.
[[nodiscard]] std::optional<Finding> contradiction(double rate, const TimeAxis& axis, const RecordingOptions& options);

/// Among the recording's remarks and doubts.
void add_contradiction(const Finding& finding, Recording& recording);

}  // namespace zwidth::internal
