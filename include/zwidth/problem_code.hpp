#pragma once

#include <cstdint>

namespace zwidth {

/// What may be wrong with an option, an argument, a file or a model, and what a computation fails of, in one list. words_of()
/// of words/problem_text.hpp makes the sentence.
enum class ProblemCode : std::uint16_t {
  // bounds
  not_above,                   ///< a quantity is not above its bound
  below_bound,                 ///< a quantity is below its bound
  not_above_zero_or_infinite,  ///< a number is not above 0, or infinite
  no_share,                    ///< a share is not from 0 to 1
  no_share_between,            ///< a share is not above 0, or above its bound
  negative,                    ///< a number is below 0
  not_finite_and_positive,     ///< a number is not finite and above 0
  not_finite_and_above,        ///< a number is not finite and above its bound
  not_finite,                  ///< a number, or one of several, is not finite
  no_finite_sum,               ///< a sum is not finite
  not_a_number,                ///< a number is NaN
  no_fraction,                 ///< a fraction is not between 0 and 1
  no_factor,                   ///< a factor is not from above 1 to 1e6
  no_growth_factor,            ///< a factor is not above 1, or above its bound
  no_whole_number,             ///< a count is out of its range
  none_asked,                  ///< a count is 0
  count_out_of_range,          ///< a count is out of its range
  count_out_of_range_or_zero,  ///< a count is neither 0 nor in its range
  too_many_threads,            ///< more threads than can be started
  too_few,                     ///< a count is below its bound
  too_many,                    ///< a count is above its bound
  too_long,                    ///< a time is above its bound
  not_below_period,            ///< a time is not below the sampling period
  not_between,                 ///< a number is out of its range
  not_above_lower_end,         ///< the upper end of a range is not above the lower
  no_part_left,                ///< a truncation leaves nothing of a distribution
  range_not_possible,          ///< a range is reversed, infinite or below 0

  // sequences
  values_not_one_a_body,    ///< as many values as bodies are needed
  value_not_finite,         ///< a value is not finite
  no_values,                ///< there is no value, sample or design
  weights_not_one_a_value,  ///< as many weights as values are needed
  values_not_rising,        ///< values do not rise

  // who holds
  needs_any_user,                      ///< a worst user without the limit over all users
  no_body_to_hold,                     ///< a transfer function has no body
  asked_of_transfer_function,          ///< a transfer function has no body
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
  band_without_line,           ///< a band holds no line of a periodic signal
  gain_margin_out_of_range,    ///< a gain margin is not from 0 to 100 dB
  phase_margin_out_of_range,   ///< a phase margin is not from 0 to 90 degrees

  // runs
  sampling_periods_disagree,         ///< the device's sampling period is not the recording's
  relay_force_out_of_range,          ///< a relay's force is not from above 0 to 1e30
  relay_force_above_limit,           ///< a relay's force is above the actuator's limit
  transfer_function_starts_at_rest,  ///< a transfer function is given a start
  samples_of_trials,                 ///< trials have too few or too many samples
  duration_out_of_range,             ///< a run has no sample or too many
  excitation_samples_out_of_range,   ///< duration and rate make too few or too many samples
  transform_too_long,                ///< one transform would be of too many samples
  no_force_would_arrive,             ///< a run or a trial is over before a force arrives
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
  damping_needed_by_drive,           ///< a cascade without damping
  torque_per_volt_missing,           ///< a motor constant is missing
  force_limit_missing,               ///< the largest force is missing
  end_stop_without_damping,          ///< an end stop has no damping
  end_stop_gain_out_of_range,        ///< an end stop's gain is out of its range
  delay_out_of_range,                ///< a delay is out of its range
  no_estimator,                      ///< a firmware without an estimator
  estimator_bandwidth_out_of_range,  ///< an estimator's bandwidth is out of its range
  no_damper_of_its_own,              ///< a drive that closes no damper beside the force that it is sent
  damper_not_faster,                 ///< a damper on the drive that runs no faster than the spring
  no_damping_for_drive,              ///< a damper on the drive without damping
  timing_of_damper_loop,             ///< rate, delay or estimator of a drive whose damper's loop the device states
  damper_on_drive_not_asked,         ///< a wall of the host, of a device whose damper runs in a loop of its own
  no_damper_loop,                    ///< a damper on the drive, of a device that does not say when it runs
  contact_beside_drive,              ///< a wall that only pushes, beside a damper that acts everywhere
  delays_apart,                      ///< two delays whose difference has no common step with the damper's period
  damper_closed_while_recorded,      ///< a record of a device whose damper's loop may have been closed

  // fits
  locking_transfer_function,  ///< a transfer function has no body to lock
  no_body_to_lock,            ///< the device has no body of this number
  locked_body_needed,         ///< the actuated or the sensed body is locked
  locked_bodies_part_device,  ///< between the actuated and the sensed body all stand still
  fit_needs_bodies,           ///< a transfer function is no structure to fit
  response_point_unusable,    ///< a point of a response cannot be fitted
  too_few_points_to_fit,      ///< no more points than free parameters
  no_number_of_structure,     ///< no number of the structure is called that
  not_in_response,            ///< a number does not show in a response
  nothing_free,               ///< no number is free
  too_many_free,              ///< too many numbers are free
  structure_never_fits,       ///< a fit finds no start

  // studies
  damping_varies,    ///< regions are over every damping
  no_specification,  ///< failures need a specification

  // numbers of the device
  no_number_of_device,       ///< no number of the device is called that
  not_of_the_limit,          ///< a number of simulation alone
  range_not_finite,          ///< a range has an end that is not finite
  range_without_width,       ///< the ends of a range are one
  range_without_factor,      ///< equal factors need ends above 0
  values_out_of_range,       ///< too few or too many values of a number
  too_many_numbers_swept,    ///< a sweep is of one or two numbers
  swept_twice,               ///< a sweep of one number over itself
  too_many_points,           ///< a sweep has too many points
  no_parameters,             ///< a study without a parameter
  too_many_parameters,       ///< too many parameters vary
  given_twice,               ///< a parameter, a key or a value is given twice
  reaches_no_device,         ///< a distribution reaches what is no device
  rows_not_one_a_parameter,  ///< a correlation needs as many rows as parameters
  row_of_other_length,       ///< a correlation needs rows as long as parameters
  diagonal_not_one,          ///< a correlation's diagonal is 1
  no_correlation,            ///< a correlation is not from -1 to 1
  not_symmetric,             ///< a correlation is not symmetric
  not_positive_definite,     ///< a correlation is not positive definite

  // uncertainty of the device
  no_parameter_of_device,      ///< no number of the device is called that
  number_without_value,        ///< the device does not have this number
  uncertainty_says_nothing,    ///< nothing is uncertain
  too_many_uncertain,          ///< too many numbers are uncertain
  covariance_rows_missing,     ///< a covariance needs as many rows as parameters
  covariance_numbers_missing,  ///< a covariance needs rows as long as parameters
  no_variance,                 ///< a variance is out of its range
  covariance_not_symmetric,    ///< a covariance is not symmetric
  covariance_too_large,        ///< a covariance is larger than two variances allow
  no_covariance,               ///< a covariance is not positive semidefinite
  values_of_two_lengths,       ///< numbers change by lists of two lengths
  nothing_changed,             ///< no number changes

  // calls
  no_body_for_user,                ///< a transfer function has no body
  no_body_to_start_from,           ///< a transfer function has no body
  start_offset_without_bodies,     ///< a transfer function has no body
  recording_without_channel,       ///< a recording has no channel
  recording_without_two_channels,  ///< a recording has not two channels
  no_recording,                    ///< there is no recording
  recordings_of_two_periods,       ///< recordings of two sampling periods
  drift_not_possible,              ///< a drift is not from above -1 to 10
  drift_without_links,             ///< the device has no link
  raster_without_walls,            ///< a raster has no wall
  grid_not_rising,                 ///< the stiffnesses of a grid do not rise
  other_devices_limit,             ///< a limit is of another device
  no_uncertainty,                  ///< the device has no uncertainty
  force_per_count_undefined,       ///< a period or a resolution is not possible
  wall_not_possible,               ///< a wall's number is not possible
  half_periods_not_ordered,        ///< half-periods are not in order
  too_many_bodies_with_friction,   ///< too many bodies rub
  motion_too_fast,                 ///< a motion is too fast to follow in time
  body_does_not_move,              ///< a position is constant
  moves_one_way,                   ///< a motion never reverses
  too_few_equations,               ///< filtering, decimation and rests leave too few samples
  equations_not_told_apart,        ///< a motion does not tell mass, friction and offset apart
  force_against_motion,            ///< a fitted mass is not above 0
  period_or_samples_not_possible,  ///< a period or a sample is not possible
  ring_down_not_possible,          ///< a period, a frequency or a sample is not possible
  transform_of_nothing,            ///< a transform of no samples
  transform_of_other_length,       ///< a transform of another length
  power_density_not_possible,      ///< a rate or a sample is not possible
  cutoff_not_possible,             ///< a cutoff is not below half the rate
  count_no_share,                  ///< more than all
  weights_not_possible,            ///< weights are not possible
  answers_not_one_a_point,         ///< as many answers as points are needed
  indices_not_possible,            ///< too few samples, or too many dimensions
  too_many_samples_in_memory,      ///< too many samples to keep
  specification_missing,           ///< failures need a specification

  // device files
  of_other_type,             ///< a value is a text, a number or a table where another is needed
  is_missing,                ///< a key is missing
  unknown_key,               ///< a table has no such key
  key_of_other_filters,      ///< a filter of this type has no such key
  no_such_name,              ///< no body, link or filter is called that
  given_beside,              ///< two keys of one quantity
  damping_of_first_order,    ///< a low-pass of order 1 has no damping ratio
  inertia_of_linear_motion,  ///< an inertia of linear motion
  not_two_bodies,            ///< a link is between two bodies
  number_beyond_range,       ///< a number is neither 0 nor from 1e-30 to 1e30
  number_without_unit,       ///< a number in quotes without a unit
  decimal_comma,             ///< a comma for the decimal mark
  unknown_unit,              ///< a unit that is not known
  unit_of_other_measure,     ///< a unit of another measure
  not_toml,                  ///< a text is not TOML
  too_many_dots,             ///< a line nests too deep
  text_without_quotes,       ///< a text without quotes
  not_an_assignment,         ///< an override without a key or a value
  not_a_toml_value,          ///< an override's value is not TOML
  in_several_tables,         ///< an override does not tell which of several tables
  no_table_to_override,      ///< an override of a body, link or filter that there is not
  value_and_no_table,        ///< an override below a key that is no table
  one_variant,               ///< one value to compare
  cannot_be_read,            ///< the system refuses to read a file
  not_a_file,                ///< a directory or a device, or no name
  too_many_bytes_read,       ///< a file or a line is too long

  // recordings as text
  no_text_table,              ///< a file of another kind than a text table
  no_rows_of_numbers,         ///< a text has no row of numbers
  format_needs_a_file,        ///< a format cannot be read from a pipe
  does_not_fit_in_memory,     ///< a recording does not fit into memory
  too_many_rows_skipped,      ///< more rows are skipped than there are
  separator_not_possible,     ///< a separator or a decimal mark is not known
  decimal_mark_is_delimiter,  ///< the decimal mark is the delimiter
  no_columns,                 ///< a recording has no columns, or none is asked for
  no_such_column,             ///< no column is called that
  column_name_not_unique,     ///< several columns are called that
  too_few_samples,            ///< a column has too few samples
  wrong_number_of_cells,      ///< a line has too few or too many cells
  line_without_header,        ///< a line comes ahead of what names its columns
  line_among_rows,            ///< a line of text stands among the rows
  section_incomplete,         ///< a section lacks names or values
  ends_in_header,             ///< a file ends in its header
  segment_of_other_columns,   ///< segments have different columns
  no_number_in_cell,          ///< a cell is no number
  too_many_samples_missing,   ///< too many samples are missing
  sample_too_large,           ///< a sample is too large
  too_many_rows_lost,         ///< too many rows are lost
  no_times,                   ///< nothing states the times
  asked_for_beside,           ///< a column and what makes it superfluous
  no_column_of_times,         ///< a column of times that is none
  times_not_rising,           ///< times do not rise
  no_timer_count,             ///< a time that the timer cannot show
  no_period_in_times,         ///< times without a sampling period
  value_without_time,         ///< a value has no time
  columns_of_other_times,     ///< columns have different times
  response_column_ambiguous,  ///< several columns may be a part of a response
  no_response_column,         ///< a part of a response has no column
  frequency_out_of_range,     ///< a frequency is out of its range
  response_line_twice,        ///< a line of a response comes twice
  magnitude_below_zero,       ///< a magnitude is negative
  no_line_in_band,            ///< no line of a response is in the band
  scale_not_possible,         ///< a scale is 0 or not finite

  // recordings in other files
  damaged_file,            ///< a MAT file is damaged from its start
  unknown_version,         ///< a MAT file is of a version that is not read
  changed_while_read,      ///< a file changed between two reads
  data_end_inside,         ///< the bytes end inside a part
  bytes_missing,           ///< fewer bytes are left than are announced
  closing_line_missing,    ///< a line -1 does not follow binary data
  unpacks_to_more,         ///< more bytes come out than may
  does_not_unpack,         ///< compressed bytes are damaged
  zlib_cannot_start,       ///< zlib lacks memory, or is of another version
  wrong_element,           ///< an element's type or bytes do not fit its part
  wrong_field,             ///< a number of a header is out of its range
  size_disagrees,          ///< numbers are more or fewer than their size says
  nested_too_deep,         ///< structs stand in structs too deep
  has_too_many,            ///< more values, columns or fields than may be
  no_table,                ///< signals are no columns of a matrix
  wrong_kind,              ///< what is there is of another kind than is wanted
  lies_elsewhere,          ///< a link, or values in another file
  not_read_by_hdf5,        ///< HDF5 refuses a part
  holds_none,              ///< a file holds nothing of what is wanted
  not_one_record,          ///< several records are a response
  samples_of_two_lengths,  ///< signals of one recording have different lengths
  axes_differ,             ///< records have other times or frequencies
  text_not_readable,       ///< a text of a universal file is not what must stand there
  file_without_columns,    ///< a universal file has records, no columns

  // studies in files
  not_told_by_uncertainty,   ///< the device's uncertainty does not have this number
  no_relative_width,         ///< a relative deviation or tolerance leaves no width
  weights_all_zero,          ///< every weight is 0
  no_file_beside_study,      ///< a study that is no file names one
  not_a_parameter_of_study,  ///< a correlation is of what does not vary
  no_samples_in_file,        ///< a file has no samples, or a line that is none

  // models and designs
  no_finite_number,                ///< a number is not above 0, below 0 or not finite
  not_one_of,                      ///< a number or a name is none of those that there are
  control_character,               ///< a text has a control character
  too_many_bytes,                  ///< a text is too long
  stands_too_often,                ///< more bodies, links or filters than there may be
  name_empty,                      ///< a body without a name
  names_two_bodies,                ///< two bodies of one name
  no_body_number,                  ///< no body of the device has this number
  tied_to_itself,                  ///< a link from a body to itself
  link_of_nothing,                 ///< a link without stiffness and damping
  body_not_connected,              ///< no links lead from a body to the others
  number_of_coefficients,          ///< too few or too many coefficients
  coefficient_out_of_range,        ///< a coefficient is neither 0 nor in its range
  all_coefficients_zero,           ///< a numerator is 0
  begins_with_zero,                ///< a denominator's leading coefficient is 0
  degree_not_lower,                ///< a numerator's degree is not below the denominator's
  longer_than_denominator,         ///< a numerator with leading zeros is longer than the denominator
  beside_transfer_function,        ///< bodies, links, a body of the loop or a user beside a transfer function
  beside_coordinates,              ///< bodies, links or a transfer function beside coordinates
  coordinates_out_of_range,        ///< no coordinates, or too many
  weights_not_one_a_coordinate,    ///< weights that are not one a coordinate, or all 0
  no_mass_matrix,                  ///< a matrix is not square, symmetric and positive definite
  no_direction,                    ///< a normal is of length 0
  tip_does_not_move,               ///< a tip cannot move along a normal
  tip_not_determined_by_encoders,  ///< encoders do not determine how a tip moves
  tip_not_moved_by_motors,         ///< motors cannot push a tip
  motor_or_encoder_depends,        ///< a motor or an encoder turns as others and cables say
  mechanism_file_refused,          ///< the reader of mechanism files refuses one
  no_such_part,                    ///< a mechanism has no part of this name
  joint_of_many_motions,           ///< a joint of a mechanism is neither hinge nor slide
  loop_does_not_close,             ///< the loops of a mechanism do not close at a pose
  no_motor,                        ///< a mechanism has no motor
  built_without_mujoco,            ///< a build that reads no mechanisms
  no_mechanism_at_pose,            ///< a mechanism without the coordinates that it has at its pose
  beside_mechanism,                ///< bodies, links, a transfer function or bodies of the loop beside a mechanism
  mechanism_of_rotary_motion,      ///< a mechanism's wall is linear
  without_mechanism,               ///< a transmission without a mechanism
  normal_not_three_numbers,        ///< a normal is not of three numbers
  point_wall_not_known,            ///< a computation that knows a wall of one direction alone
  unit_of_other_joint,             ///< a joint's position has the unit of the other kind of joint
  file_beside_text,                ///< a mechanism's file where a device came as text
  mechanism_too_large,             ///< a mechanism's text is too long, too deep or of too many elements
  no_xml,                          ///< a mechanism's text is no XML
  element_not_read,                ///< a mechanism has an element that is not read
  path_in_text,                    ///< a mechanism that is no file names one
  mass_of_mesh,                    ///< a body has its mass of a mesh
  include_not_read,                ///< a file that a mechanism includes is not there, or stands twice
  tip_stands_still,                ///< a tip cannot move at all
  not_a_mechanism,                 ///< a workspace of a device that is no mechanism
  joint_without_range,             ///< a joint of which neither the mechanism's file nor the grid says the range
  poses_given_twice,               ///< poses of a workspace are given in more than one way
  joint_given_twice,               ///< a joint stands twice in a grid of poses
  too_many_workspace_limits,       ///< too many poses times directions
  no_wall_stiffness,               ///< margins of a wall that is not given
  one_direction_alone,             ///< what a wall in several directions does not know
  coordinates_not_known,           ///< a computation that knows bodies alone
  no_body_at_all,                  ///< a device without bodies and transfer function
  no_such_body,                    ///< no body of the device is called that
  delay_of_too_many_periods,       ///< a delay of more sampling periods than are kept
  no_whole_ratio,                  ///< a damper's period is no whole part or multiple of the loop's
  filters_beside_damper_loop,      ///< filters of the wall's force, whose damper runs in a loop of its own
  damper_loop_not_known,           ///< a computation that knows one rate alone
  tracking_not_known,              ///< a computation that knows positions that are read as they are alone
  travel_per_turn_missing,         ///< a linear device's drive without its travel per turn
  no_letter,                       ///< a drive's command is not one letter
  filter_not_stable,               ///< a filter's pole does not die out
  static_gain_not_positive,        ///< a filter's static gain is not above 0
  frequency_of_digital_filter,     ///< a digital filter has no frequency of its own
  filter_frequency_out_of_range,   ///< a filter's frequency is not below Nyquist

  // identification: options, recordings and responses
  no_rising_band,                   ///< a band does not rise
  no_share_below_one,               ///< a share is not from 0 to below 1
  segments_of_periodic_force,       ///< segments of a periodic force
  periods_of_aperiodic_force,       ///< periods of an aperiodic force
  lines_beside_segments,            ///< lines beside segments or a period
  segment_not_in_record,            ///< a segment is too short or longer than the record
  period_not_in_record,             ///< a period is not from 2 samples to half of the record
  periods_all_skipped,              ///< fewer than two periods would be left
  line_beyond_nyquist,              ///< a line is not below half the sampling rate
  line_twice,                       ///< a line is asked for twice
  lines_too_close_for_record,       ///< a record is too short for its lines
  band_leaves_no_line,              ///< a band holds no line of a response
  period_without_line,              ///< a force excites no line of a period
  no_line_excited,                  ///< a force excites no line of a record
  sample_not_a_number,              ///< a sample of a signal is not finite
  force_and_motion_of_two_lengths,  ///< force and motion have different lengths
  record_of_few_samples,            ///< a record has too few samples
  signal_is_constant,               ///< a signal is constant
  force_does_not_repeat,            ///< a force has no period
  recording_twice,                  ///< two recordings hold the same samples
  response_is_continuous,           ///< a response without a sampling period
  response_of_few_lines,            ///< a response has too few lines
  no_unit_text,                     ///< a text is no unit
  unit_of_other_column,             ///< a unit is not the one of the column
  no_period_of_table,               ///< a table has no sampling period
  motion_not_fitted,                ///< no motion of this kind is fitted
  limit_part_without_value,         ///< a part of a measured limit has no =
  no_number_of_limit,               ///< a measured limit has no number of that name
  limit_without_stiffness,          ///< a measured limit has no stiffness

  // computations that do not come to their end
  outline_not_closed,              ///< the boundary of the region does not close
  boundary_not_followed,           ///< the boundary of the region turns too often
  boundary_pieces_coincide,        ///< a mode is not damped
  crossover_off_boundary,          ///< a crossover is not on the boundary
  region_changes_too_often,        ///< the region changes too often
  crossovers_not_found,            ///< modes cancel at the sensed body
  disk_peak_not_found,             ///< the disk margin's peak is not found
  response_out_of_range,           ///< a pole grows too fast for the sampling period
  response_not_computed,           ///< too many poles lie together
  no_path_of_transfer_function,    ///< a transfer function has no body
  no_body_of_path,                 ///< a path ends at no body
  state_space_of_other_sizes,      ///< the matrices of a state space do not fit
  state_space_entry_not_possible,  ///< an entry of a state space is out of its range
  modes_too_close_for_digits,      ///< modes too close for 31 digits, and too many bodies for exact arithmetic
  poles_not_found,                 ///< numbers lie too many powers of ten apart
  inner_loop_poles_not_found,      ///< those of a loop that runs inside another, many of its periods late
  too_many_poles_coincide,         ///< too many poles coincide
  too_many_poles_cancel,           ///< too many poles nearly coincide
  modes_not_told_apart,            ///< modes lie too close together
  poles_not_told_apart,            ///< poles that nearly coincide lie close to others
};

}  // namespace zwidth
