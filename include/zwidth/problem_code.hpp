#pragma once

#include <cstdint>

namespace zwidth {

/// What may be wrong with an option, in one list. words_of() of words/problem_text.hpp makes the sentence.
enum class ProblemCode : std::uint16_t {
  // bounds
  not_above,                   ///< a quantity is not above its bound
  below_bound,                 ///< a quantity is below its bound
  not_above_zero,              ///< a number is not above 0
  not_above_zero_or_infinite,  ///< a number is not above 0, or infinite
  below_zero,                  ///< a number is below 0
  no_quantity,                 ///< a quantity is not finite
  no_number,                   ///< a number is not finite
  no_frequency,                ///< a frequency is not above 0
  no_duration,                 ///< a duration is not above 0
  no_finite_force,             ///< a force is not finite
  no_share,                    ///< a share is not from 0 to 1
  no_share_between,            ///< a share is not above 0, or above its bound
  no_relative_difference,      ///< a relative difference is not between 0 and 1
  no_relative_variation,       ///< a relative variation is not from 0 to below 1
  not_positive,                ///< a number is not above 0
  negative,                    ///< a number is below 0
  not_finite_and_positive,     ///< a number is not finite and above 0
  not_finite_and_above,        ///< a number is not finite and above its bound
  not_finite,                  ///< a number is not finite
  no_finite_sum,               ///< a sum is not finite
  not_a_number,                ///< a number is NaN
  no_fraction,                 ///< a fraction is not between 0 and 1
  no_positive_quantity,        ///< a quantity is not above 0
  no_factor,                   ///< a factor is not from above 1 to 1e6
  no_growth_factor,            ///< a factor is not above 1, or above its bound
  no_ramp,                     ///< a time is not from 0 to its bound
  no_whole_number,             ///< a count is out of its range
  none_asked,                  ///< a count is 0
  count_out_of_range,          ///< a count is out of its range
  count_out_of_range_or_zero,  ///< a count is neither 0 nor in its range
  count_too_large,             ///< a count is above its bound
  too_many_threads,            ///< more threads than can be started
  points_out_of_range,         ///< a number of points is out of its range
  too_few,                     ///< a count is below its bound
  too_many,                    ///< more than there may be
  too_long,                    ///< a time is above its bound
  not_below_period,            ///< a time is not below the sampling period
  not_between,                 ///< a number is out of its range
  not_above_lower_end,         ///< the upper end of a range is not above the lower
  no_part_left,                ///< a truncation leaves nothing of a distribution
  range_not_possible,          ///< a range is reversed, infinite or below 0

  // sequences
  no_samples,               ///< there is no sample
  samples_not_finite,       ///< a sample is not finite
  values_not_one_a_body,    ///< as many values as bodies are needed
  value_not_finite,         ///< a value is not finite
  no_values,                ///< there is no value
  no_designs,               ///< there is no design
  weights_not_one_a_value,  ///< as many weights as values are needed
  values_not_rising,        ///< values do not rise

  // who holds
  needs_any_user,                      ///< a worst user without the limit over all users
  no_body_to_hold,                     ///< a transfer function has no body
  asked_of_transfer_function,          ///< a transfer function has no body
  user_of_transfer_function,           ///< a transfer function has no body
  any_user_goal_of_transfer_function,  ///< a transfer function has no body
  any_user_goal_needs_bodies,          ///< the device cannot be held, or has too many bodies
  any_user_goal_of_many_bodies,        ///< too many bodies
  too_many_bodies,                     ///< too many bodies
  user_force_without_body,             ///< a transfer function has no body
  critical_damping_without_mass,       ///< a transfer function has no mass

  // frequencies
  not_above_lowest_frequency,  ///< the highest frequency is not above the lowest
  not_below_nyquist,           ///< a frequency is not below Nyquist
  oscillation_beyond_nyquist,  ///< no loop sees an oscillation of this frequency
  no_mode_to_tune_to,          ///< the device has no resonance
  drift_out_of_range,          ///< a drift is not from 0 to 90 %
  no_modes_to_drift,           ///< the device has no link
  gain_margin_out_of_range,    ///< a gain margin is not from 0 to 100 dB
  phase_margin_out_of_range,   ///< a phase margin is not from 0 to 90 degrees

  // runs
  sampling_periods_disagree,         ///< the device's sampling period is not the recording's
  relay_force_out_of_range,          ///< a relay's force is not from above 0 to 1e30
  relay_force_above_limit,           ///< a relay's force is above the actuator's limit
  transfer_function_starts_at_rest,  ///< a transfer function is given a start
  samples_of_trials,                 ///< trials have too few or too many samples
  no_longer_than_delay,              ///< a trial is over before a force arrives
  duration_out_of_range,             ///< a run has no sample or too many
  no_force_would_arrive,             ///< a run is over before a force arrives
  over_before_user_force,            ///< a run is over before the user pushes
  no_points_kept,                    ///< no point would be kept
  too_many_points_kept,              ///< too many points would be kept
  nothing_moves,                     ///< a run without a cause of motion
  nothing_presses,                   ///< a wall that only pushes, and nothing that presses
  wall_where_nothing_moves,          ///< the wall's surface is where the device rests
  starts_where_nothing_moves,        ///< the device starts where it rests
  ceiling_below_start,               ///< a search ends before it begins
  serial_line_too_slow,              ///< a serial line carries fewer cycles than the loop runs

  // walls
  stiffness_given_twice,             ///< two options set one number
  no_wall_to_write,                  ///< the device has no wall
  neither_stiffness_nor_damping,     ///< stiffness and damping are 0
  of_the_device,                     ///< the device that the option makes is refused, for `what`
  no_stiffness_for_drive,            ///< a drive's wall without a stiffness
  filter_unknown_to_drive,           ///< a filter that the firmware lacks
  travel_missing,                    ///< a linear device without its travel per turn
  damping_needed_by_drive,           ///< a cascade without damping
  torque_per_volt_missing,           ///< a motor constant is missing
  force_limit_missing,               ///< the largest force is missing
  end_stop_without_damping,          ///< an end stop has no damping
  end_stop_gain_out_of_range,        ///< an end stop's gain is out of its range
  delay_out_of_range,                ///< a delay is out of its range
  no_estimator,                      ///< a firmware without an estimator
  estimator_bandwidth_out_of_range,  ///< an estimator's bandwidth is out of its range

  // studies
  damping_varies,    ///< regions are over every damping
  no_specification,  ///< failures need a specification
};

}  // namespace zwidth
