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
  wall_not_surely_stable,             ///< the wall lies within the interval of the critical stiffness
  interval_open,                      ///< the parameters' uncertainty leaves the limit open within more than a factor of 2
  second_route_contradicts,           ///< two computations contradict each other on one wall's stability
  second_route_undecided,             ///< no second computation confirms one wall's stability
  touch_without_pole,                 ///< the limit is a pole's touch of the circle that a second computation does not find
  slow_instability,                   ///< the free device is unstable so slowly that rounded coefficients explain it
  delay_margin_contradicts,           ///< two computations contradict each other on the delay margin
  margins_contradict,                 ///< two computations contradict each other on phase, delay and disk margin
  disk_margin_contradicts,            ///< the disk margin is larger than gain and phase margins allow
  disk_margin_left_out,               ///< its search does not end: the wall is far below every limit
  critical_damping_left_out,          ///< the largest damper alone is not sure, for `reason`
  unstable_with_nobody,               ///< the file's user alone keeps the wall stable
  stiffer_than_any_user_limit,        ///< some user's grasp makes the wall oscillate
  damper_above_any_user_limit,        ///< some user's grasp makes the damper oscillate
  too_many_bodies_for_any_user,       ///< the limit over all passive users is not computed for so many bodies
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
  start_inside_stiction,               ///< the start was moved out of the stiction, further into the wall
  start_unseen_by_encoder,             ///< the start was moved further into the wall: the encoder did not see it
  no_wall,                             ///< the device moves freely
  never_touches_wall,                  ///< the verdict is about the free device
  starts_inside_wall,                  ///< the wall pushes the device out
  never_moves_when_pushed,             ///< the user's force never overcomes the friction
  never_moves_from_start,              ///< the wall never overcomes the friction at this start
  never_moves_under_force_limit,       ///< no start lets the wall overcome the friction
  force_limit_below_friction,          ///< the actuator never overcomes the friction
  encoder_stands_still,                ///< the encoder reads one step all the time
  encoder_ripple,                      ///< the encoder's steps move the force of a device that hardly moves
  encoder_ripple_of_damper,            ///< the same, with a damper
  encoder_ripple_in_drift,             ///< the encoder's steps move the force of a device that drifts
  encoder_ripple_of_damper_in_drift,   ///< the same, with a damper
  run_ended_early,                     ///< the position passed its limit
  force_acts_to_the_end,               ///< the recorded force acts in the part that is judged
  growth_not_seen,                     ///< nothing grows within the run, but something does by linear analysis
  few_oscillations,                    ///< the run holds too few oscillations to tell
  stick_slip_not_followed,             ///< some steps had too many stick-slip instants
  swing_not_steady,                    ///< the relay's oscillation still grows or falls
  swing_varies,                        ///< the relay's oscillation does not repeat itself
  steady_part_short,                   ///< the relay's steady part is shorter than a segment
  position_drifts,                     ///< the position drifts under the relay
  few_encoder_steps,                   ///< the relay's oscillation spans few steps of the encoder
  trials_settle_apart,                 ///< the relay's trials settle at different oscillations
  no_trial_oscillates,                 ///< no trial of the relay oscillates
  relay_without_device,                ///< a relay's reading is no limit without a device file
  relay_without_finite_limit,          ///< a relay's reading is no limit: linear theory gives none
  relay_reads_more,                    ///< a relay reads more than the limit of linear theory
  relay_reads_less,                    ///< a relay reads less than the limit of linear theory
  relay_without_wall,                  ///< the relay's numbers are without the wall's damper and filters

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
  user_was_not_there,           ///< the limit measured lies below that with the file's user alone
  friction_in_response,         ///< dry friction shows as damping in a response
  force_cut_off,                ///< the force was cut off after the impulse
  no_trial_ended,               ///< no trial came to its end
  no_oscillation_grew,          ///< no oscillation grew up to the stiffest wall
  every_wall_oscillates,        ///< an oscillation grew with every wall
  growth_not_bracketed,         ///< no oscillation was read on both sides of the limit
  encoder_coarse_for_swing,     ///< the encoder is coarse for the swing
  growth_not_known,             ///< the growth rate has a large standard error
  no_smaller_impulse,           ///< no smaller impulse was tried
  smaller_impulse_not_read,     ///< after a smaller impulse no oscillation was read
  smaller_swing_decays_faster,  ///< a smaller swing decays faster: the limit depends on the swing
  smaller_swing_decays_less,    ///< a smaller swing decays less: the limit depends on the swing
  bracket_wide,                 ///< the search ended before the limit was closer
  friction_holds_swing,         ///< the limit is that of the swing after the impulse: there is friction
};

}  // namespace zwidth
