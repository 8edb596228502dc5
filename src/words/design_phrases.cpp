#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> design_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  static constexpr std::array phrases{
      Phrase{
          region_contradicts, "region_contradicts", refusal,
          "two computations contradict each other on whether the wall of {stiffness} and {damping} {damping_unit} is "
          "stable: modes lie too close together, or are too little damped, for either to be sure",
          "", "give the links their damping, or merge bodies that move alike"},
      Phrase{region_not_confirmed, "region_not_confirmed", doubt,
             "no second computation confirms the region: the loop has too many states", "",
             "shorten the delay or merge bodies that hardly move against each other"},
      Phrase{
          region_poles_on_circle, "region_poles_on_circle", doubt,
          "no second computation confirms the region: a closed-loop pole of every wall asked lies on the unit circle "
          "to rounding",
          "", "give the links their damping"},
      Phrase{region_vertex_open, "region_vertex_open", doubt,
             "the region is known to {share:percent} of its extent only: it ends beside a mode that hardly anything "
             "damps",
             "", "give the links their damping"},
      Phrase{boundary_sampled, "boundary_sampled", note,
             "the boundary was followed by samples, not by bounds, and confirmed at {walls_confirmed:n} walls",
             "a part of the region that is much thinner than its distance from K = B = 0 may be missing",
             "critical_stiffness at one damping has no such gap"},
      Phrase{region_not_converged, "region_not_converged", refusal, "{reason}", "",
             "the stable stiffnesses at one damping (wall.damping) can still be told"},
      Phrase{too_many_bodies_for_any_user_region, "too_many_bodies_for_any_user_region", note,
             "no limit for any passive user: the device has {bodies:n} bodies, more than {most:n}",
             "a user may destabilise walls of this region", "merge bodies that hardly move against each other"},
      Phrase{any_user_limit_above_nobody, "any_user_limit_above_nobody", doubt,
             "at some damping the limit for any passive user came out above that of nobody, which cannot be",
             "the lower of the two is given there, and the true one may be lower still: ask for the limit at the one "
             "damping you want"},
      Phrase{region_contradicts_limit, "region_contradicts_limit", refusal,
             "the region of stable walls contradicts the critical stiffness"},
      Phrase{limits_at_lower_end, "limits_at_lower_end", note,
             "limits are taken at the lower end of their 95 % intervals, {share} of their value",
             "the parameters of the device are known so well and no better",
             "identify them from more or longer recordings for a stiffer wall"},
      Phrase{no_any_user_limit_to_share, "no_any_user_limit_to_share", note,
             "there is no limit for any passive user to take a share of",
             "whoever holds the device may destabilise this wall"},
      Phrase{uncertainty_leaves_no_wall, "uncertainty_leaves_no_wall", refusal,
             "the uncertainty of the device leaves no wall: in more than 2.5 % of the draws none is stable", "",
             "identify it from more or longer recordings"},
      Phrase{wall_phase_margin_contradicts, "wall_phase_margin_contradicts", refusal,
             "two computations contradict each other on the phase margin of the wall found: {phase_margin_deg:.3g} "
             "degrees at {frequency_hz:.4g} Hz"},
      Phrase{wall_margins_contradict, "wall_margins_contradict", refusal,
             "the {what} found does not keep the margins asked when they are computed again"},
      Phrase{damper_contradicts, "damper_contradicts", refusal,
             "two computations contradict each other on the damper found: with nobody holding it is unstable by the "
             "poles of the loop"},
      Phrase{damper_contradicts_with_user, "damper_contradicts_with_user", refusal,
             "two computations contradict each other on the damper found: with a user of {user_mass_ratio} times the "
             "device's mass and a spring of {user_spring_ratio} B/T it is unstable by the poles of the loop"},
      Phrase{alternative_left_out, "alternative_left_out", doubt, "an alternative ({what}) is left out: {reason}"},
      Phrase{no_ripple_asked, "no_ripple_asked", note, "no greatest force per encoder count was asked",
             "one step of the encoder moves the force by {force_per_count}",
             "ask for a ripple where that can be felt or heard"},
      Phrase{
          force_per_count_unknown, "force_per_count_unknown", warning,
          "the force per encoder count could not be bounded",
          "the device has no encoder resolution: {?what=damper|the damper}{!what=damper|stiffness and damping} may be "
          "too coarse to feel",
          "give sensor.resolution"},
      Phrase{no_any_user_limit, "no_any_user_limit", warning,
             "the limit for any passive user is not available: the device as it is decides",
             "whoever holds the device may destabilise this {what}", "describe the device by bodies and links"},
      Phrase{filters_stay, "filters_stay", note, "the filters of the device's wall stay in it",
             "every number has them closed", "take them out of the file for a wall without"},
      Phrase{no_wall_keeps_margins, "no_wall_keeps_margins", warning,
             "no wall keeps the margins asked, with or without a notch",
             "a spring alone on a lightly damped device has little phase margin",
             "add a damper to the wall, or ask for less phase margin"},
      Phrase{phase_margin_bounds, "phase_margin_bounds", warning,
             "the phase margin asked allows only a small part of what the gain margin does",
             "a spring alone on a lightly damped device has little phase margin",
             "add a damper to the wall, or ask for less phase margin"},
      Phrase{no_notch_helps, "no_notch_helps", note, "no notch near a mode makes the wall stiffer", "",
             "change the device or the damper of the wall"},
      Phrase{no_counted_notch_helps, "no_counted_notch_helps", note, "no notch near a mode makes the wall stiffer",
             "those that lower the limit with any user are not counted", "change the device or the damper of the wall"},
      Phrase{every_one_stable, "every_one_stable", warning, "every {what} is stable as it is",
             "there is no limit of which a multiple could be asked", "ask for the limit to reach itself"},
      Phrase{none_stable, "none_stable", warning, "no {what} is stable as it is",
             "there is no limit of which a multiple could be asked", "ask for the limit to reach itself"},
      Phrase{limit_is_target, "limit_is_target", note, "the limit is the target already", "nothing needs to change"},
      Phrase{damper_period_follows, "damper_period_follows", note,
             "the damper's own period moves with that of the spring, in the same ratio",
             "loop.sampling_period stands for both", "give both periods where one alone is to change"},
      Phrase{
          some_numbers_followed, "some_numbers_followed", note,
          "{followed:n} of {all:n} numbers are followed, those that move the limit most, by a factor of {factor:g} at "
          "most",
          "with {bodies:n} bodies all of them would take minutes",
          "change another number and analyze again, or merge bodies whose links hardly give"},
      Phrase{branch_switches_not_searched, "branch_switches_not_searched", note,
             "with more than {most:n} bodies it is not searched where another mechanism takes over",
             "the slopes hold near the device's own values only", "sweep the number that you change"},
      Phrase{points_not_sound, "points_not_sound", refusal,
             "of {points:n} points {refused:n} are refused and {doubtful:n} doubtful", "the first: {reason}"},
      Phrase{wall_stiffness_unknown, "wall_stiffness_unknown", note, "the stiffness of the wall is not known",
             "the mechanisms are told by frequency alone; cycles of friction and of the encoder are left out",
             "give the stiffness and the damping of the wall"},
      Phrase{no_cause_fits, "no_cause_fits", doubt, "no cause fits the numbers of the device",
             "what moves it is told of the nearest cause"},
      Phrase{
          grows_at_another_frequency, "grows_at_another_frequency", doubt,
          "the loop is unstable with this wall, but grows at another frequency than the one observed: a force limit, "
          "a wall that only pushes, or a hand may move it",
          "", "soften the wall first, then look again"},
      Phrase{two_causes_fit, "two_causes_fit", doubt,
             "two mechanisms fit the frequency nearly as well: give the amplitude of the oscillation too, or let go of "
             "the device and see whether it goes on"},
      Phrase{oscillation_beside_other_motion, "oscillation_beside_other_motion", doubt,
             "the oscillation is {share:%} % of what moves in the last half of the recording", "",
             "record while it oscillates alone"},
      Phrase{oscillation_dies_out, "oscillation_dies_out", doubt,
             "the oscillation dies out, to {change:%} % from one half of the stretch to the other: nothing keeps it up",
             "", "record it while it goes on"},
      Phrase{nothing_oscillates, "nothing_oscillates", refusal,
             "nothing oscillates for four cycles and more in the last half of the recording", "",
             "record for longer, while it does"},
      Phrase{current_loop_not_modelled, "current_loop_not_modelled", doubt,
             "the drive's current loop is not modelled: the limit on the drive may be well lower", "",
             "begin with a tenth of it, and raise K by half until it vibrates"},
      Phrase{sketch_rate_assumed, "sketch_rate_assumed", note,
             "the loop of the sketch is taken to run at the device's sampling rate: measure it"},
      Phrase{drive_loop, "drive_loop", note,
             "the loop closes on the drive: {rate_hz:g} Hz, {by}, and a delay of {delay}"},
      Phrase{drive_loop_delay_assumed, "drive_loop_delay_assumed", note,
             "the loop closes on the drive: {rate_hz:g} Hz, {by}, and a delay of one period, as is taken"},
      Phrase{odrive_estimator, "odrive_estimator", note,
             "position and velocity are the estimator's: encoder.config.bandwidth {bandwidth:g} rad/s, {by}"},
      Phrase{
          moteus_estimator, "moteus_estimator", note,
          "position and velocity are the estimator's: motor_position.sources.N.pll_filter_hz {filter_hz:g}, {by}, in "
          "firmware from July 2025 on"},
      Phrase{vesc_estimator, "vesc_estimator", note,
             "the position is the encoder's, the velocity its difference: p_pid_gain_dec_angle 0, as by default; "
             "without an encoder it is an observer's, which is not modelled"},
      Phrase{openffboard_estimator, "openffboard_estimator", note,
             "the position is the encoder's; axis.0.axisfriction, axisinertia, maxspeed and maxtorquerate 0, as by "
             "default"},
      Phrase{drive_velocity_limit, "drive_velocity_limit", note,
             "the velocity limit of the drive bounds the spring: raise it above the first gain times the depth"},
      Phrase{damper_on_drive, "damper_on_drive", note,
             "a damper of {damping}{?velocity_filter_hz| behind a low-pass of {velocity_filter_hz}} that the drive "
             "closes at "
             "{rate_hz}, its force {delay:time} later, allows {gain} times the stiffness of the best damper in the "
             "spring's loop: "
             "{stiffness} rather than {one_rate_stiffness}{?any_user_stiffness|; any passive user then leaves "
             "{any_user_stiffness:limit}}{?force_per_count|; one step of the encoder then moves the force by "
             "{force_per_count}}",
             "", "set [loop.damper] to the rate and delay of the drive, and ask again"},
      Phrase{
          damper_alone_on_drive, "damper_alone_on_drive", note,
          "the drive closes the damper alone, at {rate_hz:g} Hz and with a delay of {delay}, as [loop.damper] states; "
          "it takes the spring as {?drive=odrive|the torque of the command v at velocity 0, in velocity control}"
          "{?drive=moteus|feedforward torque at velocity 0, in position mode}{?drive=simplefoc|the velocity of its "
          "torque over {damping:.6g} N m s/rad, in velocity control}"},
      Phrase{damper_estimator_not_modelled, "damper_estimator_not_modelled", doubt,
             "the damper's velocity is the drive's estimator's, which is not modelled beside [loop.damper]: the limit "
             "on the drive may be lower",
             "", "begin with a tenth of it, and raise K by half until it vibrates"}};
  return phrases;
}

}  // namespace zwidth::internal
