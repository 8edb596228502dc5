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
  untrusted_without_reason,   ///< the device file doubts its numbers and gives no reason
  assumed_numbers,            ///< numbers of the device that were assumed, not measured
  period_too_short,           ///< a sampling period that no haptic device has
  period_too_long,            ///< a sampling period that no haptic device has: the time is likely in `likely_unit`
  late_beyond_drives,         ///< delay and lag of more sampling periods than drives have
  mass_too_large,             ///< a mass that no haptic device has
  inertia_too_large,          ///< an inertia that no haptic device has
  mechanism_number_replaced,  ///< a number of the mechanism's file is another in the device file

  // stability
  wall_not_surely_stable,         ///< the wall lies within the interval of the critical stiffness
  wall_poorly_damped,             ///< the wall is stable with a small phase margin: what hits it rings for long
  interval_open,                  ///< the parameters' uncertainty leaves the limit open within more than a factor of 2
  second_route_contradicts,       ///< two computations contradict each other on one wall's stability
  second_route_undecided,         ///< no second computation confirms one wall's stability
  poles_along_circle,             ///< poles run along the unit circle: the least limit in several directions is open
  touch_without_pole,             ///< the limit is a pole's touch of the circle that a second computation does not find
  slow_instability,               ///< the free device is unstable so slowly that rounded coefficients explain it
  delay_margin_contradicts,       ///< two computations contradict each other on the delay margin
  margins_contradict,             ///< two computations contradict each other on phase, delay and disk margin
  disk_margin_contradicts,        ///< the disk margin is larger than gain and phase margins allow
  disk_margin_left_out,           ///< its search does not end: the wall is far below every limit
  too_many_states_for_damper,     ///< a damper slower than its spring, whose loop has too many states to follow
  left_out_beside_damper_loop,    ///< what is not given where the damper runs in a loop of its own
  damper_closed_at_own_rate,      ///< a response or a model is that behind a damper closed in a loop of its own
  critical_damping_left_out,      ///< the largest damper alone is not sure, for `reason`
  unstable_with_nobody,           ///< the file's user alone keeps the wall stable
  stiffer_than_any_user_limit,    ///< some user's grasp makes the wall oscillate
  damper_above_any_user_limit,    ///< some user's grasp makes the damper oscillate
  any_grasp_not_known,            ///< the limit over all passive grasps of a mechanism's tip is not computed
  any_grasp_not_known_somewhere,  ///< the same at some poses and directions of a workspace: there it may be the least
  any_grasp_scanned,              ///< the least over frequency, of a scan, with any passive grasp of a mechanism's tip
  any_grasp_bounded,              ///< of a point wall that limit lies between two bounds, of a scan
  workspace_of_tried_poses,       ///< the least over a workspace is that of the poses and directions tried
  workspace_poses_refused,        ///< some poses of a workspace are singular or not reached
  workspace_directions_refused,   ///< along some directions of a workspace no wall is known
  workspace_points_not_reached,   ///< some points of a workspace are not reached
  workspace_beyond_ranges,  ///< some poses of a workspace are beyond the ranges that the mechanism's file gives its joints
  workspace_along_normals,       ///< a wall in every direction: a workspace answers for walls along one normal each
  workspace_without_user,        ///< the limits of a workspace leave the file's user out
  workspace_least_contradicts,   ///< two computations contradict each other on the least limit of a workspace
  too_many_bodies_for_any_user,  ///< the limit over all passive users is not computed for so many bodies
  any_user_limit_scanned,        ///< the limit over all passive users is the least of a scan, not shown to be the least
  any_user_limit_may_miss_frequency,  ///< the damped bodies hardly move at some frequency that may be missed
  any_user_limit_lowered,             ///< a tuned user destabilises softer walls than the bound found: it is lowered
  any_user_limit_loose,               ///< the bound is proven to a share only, which is taken off
  any_user_limit_truncated,           ///< the sum over aliases leaves a share, which is taken off

  // design
  region_contradicts,                   ///< two computations contradict each other on one wall of the region
  region_not_confirmed,                 ///< no second computation confirms the region: too many states
  region_poles_on_circle,               ///< no second computation confirms the region: poles lie on the circle
  region_vertex_open,                   ///< a vertex of the region is known to a share of its extent only
  boundary_sampled,                     ///< the region's boundary was followed by samples, not by bounds
  region_not_converged,                 ///< the region's boundary was not followed to its end, for `reason`
  too_many_bodies_for_any_user_region,  ///< the region's limit over all passive users is not computed
  any_user_limit_above_nobody,          ///< the limit over all passive users came out above that of nobody
  region_contradicts_limit,             ///< the region contradicts the critical stiffness
  limits_at_lower_end,                  ///< the limits are the lower ends of their intervals
  no_any_user_limit_to_share,           ///< the safe wall is a share of the known holders' limits alone
  uncertainty_leaves_no_wall,           ///< in more than 2.5 % of the draws no wall is stable
  wall_phase_margin_contradicts,        ///< two computations contradict each other on the found wall's phase margin
  wall_margins_contradict,              ///< the found wall or damper fails its margins when they are computed again
  damper_contradicts,                   ///< two computations contradict each other on the found damper alone
  damper_contradicts_with_user,         ///< two computations contradict each other on the found damper with a user
  alternative_left_out,                 ///< the alternative `what` is not given, for `reason`
  no_ripple_asked,                      ///< the force of one encoder count was not bounded
  force_per_count_unknown,              ///< the force of one encoder count is not known: the file has no resolution
  no_any_user_limit,                    ///< the limit over all passive users does not exist: no bodies
  filters_stay,                         ///< the wall keeps the filters of the file
  no_wall_keeps_margins,                ///< no wall keeps the margins, with or without a notch
  phase_margin_bounds,                  ///< the phase margin allows a small part of what the gain margin does
  no_notch_helps,                       ///< no notch makes the wall stiffer
  no_counted_notch_helps,               ///< no notch makes the wall stiffer without lowering another limit
  every_one_stable,                     ///< every wall or damper is stable: there is no limit to move
  none_stable,                          ///< no wall or damper is stable: there is no limit to move
  limit_is_target,                      ///< the limit is the target already
  damper_period_follows,                ///< the damper's own period moves with that of the spring
  some_numbers_followed,                ///< of many numbers those that move the limit most are followed
  branch_switches_not_searched,         ///< where another mechanism takes over is not searched for so many bodies
  points_not_sound,                     ///< some points of a sweep are refused or doubtful
  wall_stiffness_unknown,               ///< an oscillation is explained by its frequency alone
  no_cause_fits,                        ///< no cause explains the oscillation by the numbers of the device
  grows_at_another_frequency,           ///< the loop is unstable, but not at the frequency observed
  two_causes_fit,                       ///< two causes explain the oscillation nearly as well
  oscillation_beside_other_motion,      ///< the oscillation is a small share of what moves
  oscillation_dies_out,                 ///< the oscillation decays
  nothing_oscillates,                   ///< the recording holds no oscillation
  current_loop_not_modelled,            ///< the drive's current loop is not modelled
  sketch_rate_assumed,                  ///< the rate of the drive's loop is taken from the device
  drive_loop,                           ///< rate and delay of the drive's loop
  drive_loop_delay_assumed,             ///< rate of the drive's loop; its delay is taken as one period
  odrive_estimator,                     ///< where the firmware's position and velocity come from
  moteus_estimator,                     ///< where the firmware's position and velocity come from
  vesc_estimator,                       ///< where the firmware's position and velocity come from
  openffboard_estimator,                ///< where the firmware's position and velocity come from
  drive_velocity_limit,                 ///< the drive's velocity limit bounds the spring
  damper_on_drive,                      ///< what a damper gains that the drive closes in a loop of its own
  damper_alone_on_drive,                ///< the drive closes the damper alone, and how the spring reaches it
  damper_estimator_not_modelled,        ///< the drive's damper takes its velocity from an estimator

  // reasons of design: why there is no answer, and what an oscillation is
  no_stiffness_too_much,                  ///< the force does not move what is sensed: every wall is stable
  no_damping_too_much,                    ///< the same of dampers
  every_wall_destabilised,                ///< some passive user destabilises any wall: nothing damps a motion
  every_damper_destabilised,              ///< the same of dampers
  hardly_any_wall_keeps_margins,          ///< with some passive user only a very soft wall keeps the margins
  no_wall_stable_with_any_damper,         ///< no wall is stable from K = 0 on
  no_damper_stable,                       ///< no damper is stable from B = 0 on
  no_wall_with_damped_contact,            ///< no wall keeps the margins without a swinging contact
  no_wall_keeps_margins_with_any_filter,  ///< no wall keeps the margins with any damper and velocity filter
  lower_end_leaves_no_margins,            ///< at the lower end of the uncertainty no wall keeps the margins
  uncertainty_leaves_no_margins,          ///< in more than a share of the draws no wall keeps what is asked
  uncertainty_leaves_no_damper,           ///< the uncertainty leaves no damper
  drift_leaves_no_wall,                   ///< at some drift of the modes no wall keeps what is asked
  drift_leaves_no_damper,                 ///< at some drift of the modes no damper keeps what is asked
  notch_lowers_any_user_limit,            ///< the notch lowers the limit with any passive user at some drift
  largest_damper_unknown,                 ///< the largest damper alone is not known
  no_damper_too_large,                    ///< every damper alone is stable
  device_refused,                         ///< the device's numbers are refused
  too_many_bodies_for_wall_summary,       ///< the walls beside an analysis take long for so many bodies
  limit_refused_at_value,                 ///< the limit at the value found is refused, for `reason`
  limit_jumps_across_target,              ///< the limit jumps across the target: another mechanism takes over
  any_user_limit_at_target,               ///< the limit over all passive users is the target at the value
  rigid_body_limit_at_target,             ///< the limit is the target at the value, set by the rigid body
  mode_limit_at_target,                   ///< the limit is the target at the value, set by a vibration mode
  stable_at_every_value,                  ///< every wall or damper is stable at every value of the number
  limit_stays_below_target,               ///< at no value of the number the limit gets as high as the target
  limit_stays_above_target,               ///< at no value of the number the limit gets as low as the target
  number_not_followed,                    ///< of many numbers those that move the limit most are followed
  no_crossover,                           ///< no stiffness puts a pole on the unit circle
  crossover_at_frequency,                 ///< a phase crossover near the frequency observed
  loop_stable,                            ///< the loop is stable with this wall
  loop_unstable,                          ///< the loop is unstable with this wall
  no_user_destabilises_wall,              ///< no passive user makes a wall oscillate at the frequency observed
  no_user_destabilises_damper,            ///< no passive user makes a damper oscillate at the frequency observed
  some_user_destabilises,                 ///< some passive user makes it oscillate at the frequency
  unstable_without_steps,                 ///< the loop is unstable without the encoder's steps
  no_crossover_for_steps,                 ///< the encoder's steps have no phase crossover to swing at
  friction_holds_against_steps,           ///< friction holds against half an encoder step's force
  swing_beyond_steps,                     ///< the swing is larger than the encoder's steps keep up
  cycle_of_steps,                         ///< the encoder is a relay: a cycle at a phase crossover
  resonance_of_steps,                     ///< the loop resonates and swings by many encoder steps
  friction_destabilises_nothing,          ///< friction that holds a body makes no stable loop unstable
  friction_cycle_of_other_swing,          ///< the cycle of friction has another amplitude
  friction_cycle,                         ///< a cycle of friction at the frequency

  // study
  units_without_answer,            ///< some units have no answer and count as failures
  unit_limits_doubtful,            ///< the limits of some units are doubtful
  nothing_specified,               ///< the study has no specification: no yield
  samples_spread_evenly,           ///< the intervals are those of independent samples, which these are not
  few_samples_for_tails,           ///< too few samples for a bound of 95 % of the units
  rare_share_contradicts,          ///< importance sampling contradicts the samples on the share of failures
  no_indices_correlated,           ///< no Sobol indices: the parameters are correlated
  no_indices_too_many_parameters,  ///< no Sobol indices: too many parameters
  no_indices_unbounded,            ///< no Sobol indices: some units have no finite limit
  index_limits_doubtful,           ///< the limits of some units of the Sobol indices are doubtful
  index_not_known,                 ///< a Sobol index has a large standard error
  parameter_without_effect,        ///< a parameter changes no unit's critical stiffness
  worse_may_have_no_answer,        ///< some units have no answer: one may be worse than the worst one
  one_descent_alone,               ///< one descent alone ended at the worst unit
  study_with_user,                 ///< all limits are with the file's user; nobody holding leaves less
  walls_without_answer,            ///< some units and dampings have no answer and count as unstable
  wall_limits_doubtful,            ///< the limits of some units and dampings are doubtful
  no_scale_of_dampings,            ///< the device on paper has no region that gives the scale of the dampings
  contours_go_on,                  ///< the contours of the region end where the search ended
  no_failure_found,                ///< no failure to sample around was found
  few_effective_units,             ///< the share of rare failures rests on few units, or on one of great weight
  drawn_units_without_answer,      ///< some units of the importance sampling have no answer and count as failures
  drawn_limits_doubtful,           ///< the limits of some units of the importance sampling are doubtful

  // simulation
  start_inside_stiction,              ///< the start was moved out of the stiction, further into the wall
  start_unseen_by_encoder,            ///< the start was moved further into the wall: the encoder did not see it
  no_wall,                            ///< the device moves freely
  never_touches_wall,                 ///< the verdict is about the free device
  starts_inside_wall,                 ///< the wall pushes the device out
  never_moves_when_pushed,            ///< the user's force never overcomes the friction
  never_moves_from_start,             ///< the wall never overcomes the friction at this start
  never_moves_under_force_limit,      ///< no start lets the wall overcome the friction
  force_limit_below_friction,         ///< the actuator never overcomes the friction
  encoder_stands_still,               ///< the encoder reads one step all the time
  encoder_ripple,                     ///< the encoder's steps move the force of a device that hardly moves
  encoder_ripple_of_damper,           ///< the same, with a damper
  encoder_ripple_in_drift,            ///< the encoder's steps move the force of a device that drifts
  encoder_ripple_of_damper_in_drift,  ///< the same, with a damper
  run_ended_early,                    ///< the position passed its limit
  force_acts_to_the_end,              ///< the recorded force acts in the part that is judged
  growth_not_seen,                    ///< nothing grows within the run, but something does by linear analysis
  few_oscillations,                   ///< the run holds too few oscillations to tell
  stick_slip_not_followed,            ///< some steps had too many stick-slip instants
  swing_not_steady,                   ///< the relay's oscillation still grows or falls
  swing_varies,                       ///< the relay's oscillation does not repeat itself
  steady_part_short,                  ///< the relay's steady part is shorter than a segment
  position_drifts,                    ///< the position drifts under the relay
  few_encoder_steps,                  ///< the relay's oscillation spans few steps of the encoder
  trials_settle_apart,                ///< the relay's trials settle at different oscillations
  no_trial_oscillates,                ///< no trial of the relay oscillates
  relay_without_device,               ///< a relay's reading is no limit without a device file
  relay_without_finite_limit,         ///< a relay's reading is no limit: linear theory gives none
  relay_reads_more,                   ///< a relay reads more than the limit of linear theory
  relay_reads_less,                   ///< a relay reads less than the limit of linear theory
  relay_without_wall,                 ///< the relay's numbers are without the wall's damper and filters

  // reasons of relays: why a record is not read, and what a reading means
  record_too_short,                   ///< fewer samples than can be analysed
  force_never_changes,                ///< a force of one value
  position_never_changes,             ///< a position of one value
  force_stops_changing,               ///< the force is constant in the last half
  position_stops_changing,            ///< the position is constant in the last half
  too_few_cycles,                     ///< the record holds no oscillation of enough cycles
  too_few_cycles_in_segment,          ///< a segment holds too few cycles of the oscillation
  no_frequency_stands_out,            ///< the strongest line holds a small share of the motion's power
  trials_at_different_oscillations,   ///< the trials settle at different oscillations
  no_linear_crossover,                ///< linear theory knows no phase crossover
  reads_more_at_crossover,            ///< it oscillates near a phase crossover, and reads more
  reads_less_at_crossover,            ///< it oscillates near a phase crossover, and reads less
  oscillates_off_crossovers,          ///< it oscillates at no phase crossover
  reading_confirms_limit,             ///< the reading is the limit of linear theory
  reading_coincides_with_limit,       ///< the reading is the limit's stiffness at another frequency
  reading_above_limit,                ///< the reading lies above the limit of linear theory
  reading_below_limit,                ///< the reading lies below the limit of linear theory
  no_linear_limit,                    ///< linear theory gives no finite limit
  friction_leaves_no_cycle,           ///< with friction, first harmonics give no oscillation near this one
  friction_moves_cycle,               ///< friction moves the oscillation away from the crossover
  friction_leaves_cycle,              ///< friction leaves the oscillation near the crossover
  sampled_relay_without_oscillation,  ///< the sampled relay alone has no simple oscillation
  sampled_relay_has_this_one,         ///< this oscillation is an exact one of the sampled relay alone
  sampled_relay_apart_by_friction,    ///< this oscillation is none of the sampled relay's: friction
  sampled_relay_apart_by_switches,  ///< this oscillation is none of the sampled relay's: more switches, or the encoder

  // rig
  interrupted,                  ///< the session was interrupted
  position_not_a_number,        ///< a position or a force was not a number
  beyond_position_limit,        ///< the position went beyond its limit
  beyond_velocity_limit,        ///< the velocity went beyond its limit
  force_limited_too_long,       ///< more force was wanted than is allowed, for too long
  missed_cycles,                ///< too many cycles in a row came late
  lost_link,                    ///< too many cycles in a row brought no position
  drive_in_trouble,             ///< there was no position: the drive itself says why
  watchdog_fired,               ///< the loop stood still
  oscillation_grew,             ///< an oscillation grew
  moves_against_force,          ///< under a force the position moved the other way
  moves_under_no_force,         ///< under a force the position did not move so that its sign is known
  cycles_unanswered,            ///< cycles brought no position, and repeated the last force
  drive_limits_force,           ///< the drive limits the force below the rig's force limit
  drive_drops_small_forces,     ///< the drive makes no current of a small force
  drive_filters_position,       ///< the drive filters the position that it tells otherwise than the file says
  drive_settings_unknown,       ///< of a firmware whose settings are not known
  drive_after_watchdog,         ///< what the motor does once the drive's watchdog has let go
  memory_not_locked,            ///< the system refuses to lock memory
  no_real_time_priority,        ///< the system refuses real-time priority
  no_processor_of_its_own,      ///< the system refuses to bind the loop to a processor
  check_cut_short,              ///< the rig stopped before the check was over, for `reason`
  first_trial_cut_short,        ///< the rig stopped in the relay's first trial, for `reason`
  search_cut_short,             ///< the rig stopped before an oscillation grew, for `reason`
  record_cut_short,             ///< the rig stopped before its record was whole, for `reason`
  wall_cut_short,               ///< the rig stopped before the wall's time was over, for `reason`
  force_kept_back,              ///< the wall that was felt is softer than the one asked
  position_never_changed,       ///< the position never changed under force
  unstable_and_stopped,         ///< the wall is unstable by linear analysis; the rig stopped
  unstable_growing_slowly,      ///< the wall is unstable by linear analysis; its oscillation grew slowly
  unstable_unseen,              ///< the wall is unstable by linear analysis; no oscillation was seen to grow
  stable_wall_oscillates,       ///< an oscillation grew in a wall that is stable by linear analysis
  device_bears_less,            ///< the limit measured lies below what the file promises
  prediction_above_measured,    ///< the predicted limit lies above the one measured
  file_promises_more,           ///< the limits of the file lie above the one measured
  measured_below_promise,       ///< the limit measured lies below what the file promises, not surely
  measured_above_promise,       ///< the limit measured lies above what the file promises
  user_was_not_there,           ///< the limit measured lies below that with the file's user alone
  friction_in_response,         ///< dry friction shows as damping in a response
  force_cut_off,                ///< the force was cut off after the impulse
  no_trial_ended,               ///< no trial came to its end
  no_oscillation_grew,          ///< no oscillation grew up to the stiffest wall
  every_wall_oscillates,        ///< an oscillation grew with every wall
  growth_not_bracketed,         ///< no oscillation was read on both sides of the limit
  encoder_coarse_for_swing,     ///< the encoder is coarse for the swing
  growth_not_known,             ///< the growth rate has a large standard error
  growth_not_told,              ///< softer walls were tried of which nobody can tell whether their oscillation grows
  no_smaller_impulse,           ///< no smaller impulse was tried
  smaller_impulse_not_read,     ///< after a smaller impulse no oscillation was read
  smaller_swing_decays_faster,  ///< a smaller swing decays faster: the limit depends on the swing
  smaller_swing_decays_less,    ///< a smaller swing decays less: the limit depends on the swing
  bracket_wide,                 ///< the search ended before the limit was closer
  friction_holds_swing,         ///< the limit is that of the swing after the impulse: there is friction

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

  // identification
  excitation_rounded,               ///< a duration is rounded to whole samples
  excitation_shorter_than_cycle,    ///< a record shorter than a cycle of its lowest frequency
  excitation_beyond_force_limit,    ///< the excitation is beyond the actuator's limit
  excitation_beyond_stroke,         ///< the excitation moves the device beyond the stroke
  excitation_moves_few_steps,       ///< the excitation moves the device by few encoder steps
  excitation_of_doubtful_device,    ///< the excitation is computed of a device that is doubted
  stroke_without_friction,          ///< the stroke is computed without Coulomb friction
  channel_in_counts,                ///< a channel (0: force, 1: motion) holds whole numbers, as a converter counts
  force_of_two_values,              ///< a force of two values: an amplifier that gives less does not show
  channels_of_two_motions,          ///< force and motion of a linear and a rotary device
  channel_of_other_quantity,        ///< a column's unit is that of another quantity
  channel_unit_unknown,             ///< a column's unit is none of the quantity that it is taken for
  channel_of_other_motion,          ///< a column's unit is that of the other motion than the structure's
  force_beyond_limit,               ///< the recorded force is beyond the structure's limit
  rows_thinned,                     ///< the rows' period is a multiple of the loop's
  clipped_for_response,             ///< a clipped signal, of which a response was taken
  clipped_for_equations,            ///< a clipped signal, to which equations of motion were fitted
  segments_averaged,                ///< how a response was averaged over segments
  lines_of_whole_record,            ///< how a response was taken from the lines of a whole record
  begins_at_rest,                   ///< a record that begins at rest
  lines_of_record_ends,             ///< lines that only the ends of a record excite
  too_few_averages,                 ///< fewer than two independent averages
  segments_too_short,               ///< the window smears a resonance
  periods_averaged,                 ///< how a response was averaged over periods
  transient_in_periods,             ///< the first periods differ from the later ones
  force_repeats,                    ///< the period that was found
  sine_fitted_in_one_piece,         ///< a single sine
  lines_fitted_in_blocks,           ///< lines fitted in blocks of a record
  velocity_integrated,              ///< a velocity is turned into a position
  acceleration_integrated,          ///< an acceleration is turned into a position
  response_without_rate,            ///< a response without a sampling rate has no critical stiffness
  response_of_one_line,             ///< a response of a single line has no critical stiffness
  response_without_noise,           ///< a response whose noise is not known
  phase_measured,                   ///< where the phase is known
  phase_half_turn_off,              ///< the motion's sign is probably wrong
  phase_left_open,                  ///< noise leaves the phase open by more than 30 degrees in the whole band
  phase_not_told,                   ///< noise hides the phase everywhere
  phase_past_at_beginning,          ///< the phase is past -180 degrees where the band begins
  no_crossover_in_band,             ///< the phase does not pass -180 degrees
  noise_may_hide_softer_crossover,  ///< noise hides where a softer crossover may lie
  noise_hides_crossover,            ///< noise hides where a crossover may lie
  lines_too_far_apart,              ///< a resonance between neighbouring lines
  springlike_at_beginning,          ///< the low-frequency slope is that of a spring
  not_rigid_at_beginning,           ///< the low-frequency slope is not that of a rigid body
  gap_between_lines,                ///< a wide gap between excited lines
  no_limit_proven,                  ///< the data prove no critical stiffness
  recordings_differ,                ///< recordings of about the same force differ
  response_depends_on_force,        ///< the response depends on the force, not as by dry friction
  response_depends_as_by_friction,  ///< the response depends on the force as by dry friction
  recordings_disagree_on_limit,     ///< recordings whose critical stiffness lies outside the interval of all
  motion_shows_friction,            ///< the motion shows dry friction that the response takes for damping
  motion_shows_drag,                ///< the motion shows drag that the response takes for damping
  friction_would_pass_unseen,       ///< dry friction of a size that matters would not show
  friction_unknown,                 ///< the recordings do not show dry friction, nor exclude it
  one_amplitude,                    ///< forces of one amplitude do not show what is not linear
  table_hides_friction,             ///< a table does not show dry friction
  table_gives_no_reason,            ///< a table doubts its critical stiffness and gives no reason
  motion_against_force,             ///< the position falls as the force rises
  nothing_determined,               ///< the data determine no parameter
  parameter_unidentifiable,         ///< the response says nothing about a parameter
  only_combination_identifiable,    ///< the response determines a combination of parameters only
  parameter_hardly_determined,      ///< a parameter known to half its size or less
  search_stopped,                   ///< the search was stopped while it still moved the limit
  motion_tells_no_limit,            ///< the motion leaves the critical stiffness open, the response's lines do not
  limit_outside_band,               ///< the crossover that limits is outside the measured band
  data_leave_interval_open,         ///< the data leave the critical stiffness open
  residual_stands_out,              ///< what the best fit leaves of a record is more than its noise
  fitted_late_beyond_drives,        ///< a fitted delay and lag that no drive has
  fitted_body_too_heavy,            ///< a fitted mass or inertia that no haptic device has
  mass_far_from_structure,          ///< a fitted mass powers of ten off the structure's
  period_far_from_record,           ///< the structure's sampling period is powers of ten off the record's
  delay_contradicts_structure,      ///< the record shows another delay than the structure's
  delay_not_shown,                  ///< the delay from force to motion does not show
  force_acts_later,                 ///< the force acts later than a held one
  operator_taken_to_hold,           ///< the structure's operator is taken to hold the device
  nobody_taken_to_hold,             ///< nobody is taken to have held the device
  force_taken_for_command,          ///< the force is taken for the commanded one
  rows_fitted_in_part,              ///< of long recordings evenly spread parts are fitted
  force_of_one_size,                ///< a drive that loses of its force passes for another gain
  further_body_fitted,              ///< a body that the structure lacks and the motion shows
  dry_friction_fitted,              ///< dry friction beside the linear device
  constant_force,                   ///< a constant force beside the recorded one
  taken_as_zero,                    ///< a fitted value below 0
  friction_below_zero,              ///< friction below 0 by more than its interval
  force_unexplained,                ///< one rigid body leaves a share of the force unexplained
  device_not_rigid,                 ///< a mode of a device that was taken for one rigid body

  // simulation of mechanisms
  motion_linearised,  ///< the motion is that of the mechanism linearised at its pose
  friction_left_out,  ///< the same, without the friction of joints and cables

  // mechanisms
  tip_loses_directions,      ///< a singular pose: grasps beside it hold more directions, and leave less
  workspace_poses_singular,  ///< at some poses of a workspace the tip moves along fewer directions than beside
  point_margins_left_out,    ///< margins of a wall in every direction are not all found
};

}  // namespace zwidth
