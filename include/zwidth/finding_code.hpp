#pragma once

#include <cstdint>

namespace zwidth {

/// What zwidth may find, in one list. name_of() of words/finding_text.hpp is the name in documents.
enum class FindingCode : std::uint16_t {
  // anywhere
  stated,          ///< a file or a user says so, in the sentence `reason`
  left_out,        ///< `what` is not given, for `reason`
  nobody_holding,  ///< `reason` holds of the device that nobody holds
  not_converged,   ///< a computation did not come to its end, for `reason`

  // model: the device's numbers
  untrusted_without_reason,  ///< the device file doubts its numbers and gives no reason
  assumed_numbers,           ///< numbers of the device that were assumed, not measured
  period_too_short,          ///< a sampling period that no haptic device has
  period_too_long,           ///< a sampling period that no haptic device has: the time is likely in `likely_unit`
  late_beyond_drives,        ///< delay and lag of more sampling periods than drives have
  mass_too_large,            ///< a mass that no haptic device has
  inertia_too_large,         ///< an inertia that no haptic device has

  // stability
  wall_not_surely_stable,        ///< the wall lies within the interval of the critical stiffness
  interval_open,                 ///< the parameters' uncertainty leaves the limit open within more than a factor of 2
  second_route_contradicts,      ///< two computations contradict each other on one wall's stability
  second_route_undecided,        ///< no second computation confirms one wall's stability
  touch_without_pole,            ///< the limit is a pole's touch of the circle that a second computation does not find
  slow_instability,              ///< the free device is unstable so slowly that rounded coefficients explain it
  delay_margin_contradicts,      ///< two computations contradict each other on the delay margin
  margins_contradict,            ///< two computations contradict each other on phase, delay and disk margin
  disk_margin_contradicts,       ///< the disk margin is larger than gain and phase margins allow
  disk_margin_left_out,          ///< its search does not end: the wall is far below every limit
  critical_damping_left_out,     ///< the largest damper alone is not sure, for `reason`
  unstable_with_nobody,          ///< the file's user alone keeps the wall stable
  stiffer_than_any_user_limit,   ///< some user's grasp makes the wall oscillate
  damper_above_any_user_limit,   ///< some user's grasp makes the damper oscillate
  too_many_bodies_for_any_user,  ///< the limit over all passive users is not computed for so many bodies
  any_user_limit_may_miss_frequency,  ///< the damped bodies hardly move at some frequency that may be missed
  any_user_limit_lowered,             ///< a tuned user destabilises softer walls than the bound found: it is lowered
  any_user_limit_loose,               ///< the bound is proven to a share only, which is taken off
  any_user_limit_truncated,           ///< the sum over aliases leaves a share, which is taken off

  // signal
  signal_short,      ///< few samples
  signal_constant,   ///< one value throughout: nothing excites, or nothing was measured
  signal_quantised,  ///< few different values
  signal_clipped,    ///< plateaus at an extreme value
  signal_idle,       ///< a force that stays at 0 for long
  signal_lost,       ///< a signal that stays at a value for long and jumps away from it

  // io: what was read, and what was passed over
  text_table,                     ///< how a text's columns and rows were read
  header_with_numbers,            ///< a header that may be a row
  last_line_cut_off,              ///< the last line is left out
  last_line_without_end,          ///< the last line of a TwinCAT Scope export is left out
  empty_lines_in_rows,            ///< empty lines between rows
  rows_outside_common_span,       ///< rows of a column outside of the span of all
  samples_missing,                ///< samples that are no number, filled by straight lines
  column_scaled_by_its_unit,      ///< a column is read in base units
  column_unit_unknown,            ///< a column whose unit is no force or motion
  column_read_in_unit,            ///< a response's column is read in the unit of its name
  rows_repeated,                  ///< rows that say again what the row before says
  rows_lost,                      ///< gaps in the times
  jitter_of_rows,                 ///< rows off equal steps: interpolated
  jitter_of_stamps,               ///< times off equal steps, rows not
  jitter_undecided,               ///< rows or times off equal steps
  rate_of_times,                  ///< the rate that the times state
  rate_of_file,                   ///< the rate that the file states
  rate_contradicts_times,         ///< the rate given is not that of the times
  rate_contradicts_file,          ///< the rate given is not the file's
  period_unusual,                 ///< a sampling period beyond what devices have
  stated_offset_unused,           ///< a header states an offset
  stated_scale_unused,            ///< a header states a scale, and one is given
  stated_scale_unclear,           ///< a header states a scale: applied or not
  more_rows_than_stated,          ///< rows without times, more than their header says
  channel_sampled_off_the_first,  ///< a scanner's channel is sampled at another instant
  twincat_scope_export,           ///< what was read
  slow_rows_repeated,             ///< rows of slow channels, repeated in a TwinCAT Scope export
  codesys_trace,                  ///< what was read
  controldesk_export,             ///< what was read
  labview_measurement_file,       ///< what was read
  objects_skipped,                ///< MATLAB objects
  not_numeric_skipped,            ///< MATLAB arrays of other classes
  complex_skipped,                ///< complex MATLAB arrays
  no_signals_skipped,             ///< MATLAB arrays that are no signals
  damaged_skipped,                ///< MATLAB arrays that cannot be read
  single_numbers,                 ///< numbers of a MAT file beside its signals
  datasets_passed_over,           ///< datasets of a universal file that are no functions
  dataset_not_closed,             ///< a dataset of a universal file without an end
  function_cut_off,               ///< a function of a universal file with fewer points than stated
  response_of_velocity,           ///< a response that is divided by jw
  response_of_acceleration,       ///< a response that is divided by -w^2
  response_of_unknown_quantity,   ///< a response taken for one of a position
  repeated_lines_averaged,        ///< several lines of a response at one frequency
  lines_without_number,           ///< lines of a response that are left out
  zero_frequency_left_out,        ///< the line of a response at 0 Hz
};

}  // namespace zwidth
