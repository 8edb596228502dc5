#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> identification_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  // What a fit makes of a force that its structure lacks.
  static constexpr const char* taken_for =
      "{?taken_for=damping|the fit takes it for mass, damping and springs}{?taken_for=friction|the fit takes it for "
      "mass, friction and offset}";
  static constexpr std::array phrases{
      Phrase{motion_against_force, "motion_against_force", refusal,
             "the position falls as the force rises: scale one of them by -1"},
      Phrase{explained_better_if_turned, "explained_better_if_turned", warning,
             "with its sign turned round, {turned:percent} of the response would be unexplained, not "
             "{unexplained:percent}",
             "the position falls as the force rises", "scale one of them by -1"},
      Phrase{response_unexplained, "response_unexplained", refusal,
             "the structure leaves {unexplained:percent} of the response unexplained", "",
             "is the structure right, and are force and position those of one experiment?"},
      Phrase{response_in_time_unexplained, "response_in_time_unexplained", refusal,
             "the fitted device leaves {unexplained:percent} of the response of {source} unexplained", "",
             "is the structure right, and are force and position those of one experiment?"},
      Phrase{response_drowned, "response_drowned", refusal, "the response hardly stands out of its noise anywhere", "",
             "excite more strongly, and check that force and position are those of one experiment"},
      Phrase{nothing_determined, "nothing_determined", refusal,
             "the {?by=record|record determines}{?by=recordings|recordings determine} no parameter of the structure",
             "", "free fewer, or excite more strongly"},
      Phrase{numbers_undetermined, "numbers_undetermined", doubt,
             "the data do not determine {keys}: taken as they stand in the "
             "{?taken_from=structure|structure}{?taken_from=start|start of the search}"},
      Phrase{number_is_placeholder, "number_is_placeholder", warning,
             "{key} = {value:.4g} is a placeholder: the data do not determine it",
             "give what is known, or a device file as the structure"},
      Phrase{parameter_unidentifiable, "parameter_unidentifiable", warning, "the response says nothing about {key}",
             "it stays near the structure's value, without an interval"},
      Phrase{only_combination_identifiable, "only_combination_identifiable", warning,
             "the response determines only a combination of {keys}",
             "they stay as near the structure's values as the data allow, without an interval"},
      Phrase{parameter_hardly_determined, "parameter_hardly_determined", warning,
             "{key} is known to {relative_deviation:percent} only (one standard deviation)",
             "the data hardly determine it"},
      Phrase{fitted_too, "fitted_too", note,
             "{key} is fitted too: {?given|the record shows another than the structure's {given:.4g} s}{!given|the "
             "record is explained better with it}"},
      Phrase{search_stopped, "search_stopped", doubt,
             "the search for the parameters was stopped while it still improved", "",
             "free fewer parameters, or start from values that are nearly right"},
      Phrase{local_minimum, "local_minimum", doubt,
             "other values of its numbers explain the record better: the search ended beside the device", "",
             "excite more strongly or for longer, or give values that are nearly right"},
      Phrase{held_to_critical_point, "held_to_critical_point", note,
             "the fit is held to the measured critical point, since the structure misses the data by more than their "
             "noise",
             "all points alike would give a critical stiffness of {without:.4g}"},
      Phrase{critical_point_is_guess, "critical_point_is_guess", doubt,
             "the fit is held to a measured critical point that is itself a guess"},
      Phrase{limit_outside_band, "limit_outside_band", doubt,
             "the crossover that limits, near {frequency:.4g} Hz, lies {side} the measured band, {lowest:.4g} to "
             "{highest:.4g} Hz: {?side=above|delay, lag and modes there are not in the data; excite higher "
             "frequencies}{?side=below|dampings and springs there are not in the data; excite lower frequencies}"},
      Phrase{limit_extrapolated, "limit_extrapolated", warning,
             "the critical stiffness is extrapolated {side} the measured band",
             "the crossover that limits, near {frequency:.4g} Hz, lies {side} the measured band, {lowest:.4g} to "
             "{highest:.4g} Hz: {?side=above|delay, lag and modes there are not in the data; excite higher "
             "frequencies}{?side=below|dampings and springs there are not in the data; excite lower frequencies}"},
      Phrase{limit_above_measured, "limit_above_measured", doubt,
             "UNSAFE: the critical stiffness of the recorded device as fitted, {fitted:.4g} {unit}, lies above "
             "{proven:.4g}, where the same data show an oscillation without any model",
             "the structure lacks something",
             "use the critical stiffness of the response itself; free delay and lag, or name bodies that were "
             "locked"},
      Phrase{limit_may_be_wrong, "limit_may_be_wrong", warning, "{reason}", "the critical stiffness may be wrong"},
      Phrase{unseen_limit_within_interval, "unseen_limit_within_interval", doubt,
             "{key} is known to {relative_deviation:percent} only: within that a crossover near {frequency:.4g} Hz, "
             "{side} the measured band, may limit at {stiffness:.4g} {unit}",
             "", "excite {?side=above|higher}{?side=below|lower} frequencies"},
      Phrase{unseen_limit_of_light_mode, "unseen_limit_of_light_mode", doubt,
             "the record does not show how much a mode above it is damped: hardly at all, a crossover near "
             "{frequency:.4g} Hz, {side} the measured band, may limit at {stiffness:.4g} {unit}",
             "", "excite {?side=above|higher}{?side=below|lower} frequencies"},
      Phrase{unseen_limit_of_other_values, "unseen_limit_of_other_values", doubt,
             "the record leaves numbers open: with others that explain it as well a crossover near {frequency:.4g} Hz, "
             "{side} the measured band, may limit at {stiffness:.4g} {unit}",
             "", "excite {?side=above|higher}{?side=below|lower} frequencies"},
      Phrase{data_leave_interval_open, "data_leave_interval_open", doubt,
             "{?delay_within_ms|the delay is known to +-{delay_within_ms:.2g} ms only: }the data leave the critical "
             "stiffness open {?factor|within a factor of {factor:.2g}}{?more_than|by more than a factor of "
             "{more_than:.0f}}{!factor|{!more_than|down to 0, where not even the softest wall is stable}}",
             "", "excite more strongly or for longer{?delay_within_ms|, and at higher frequencies}"},
      Phrase{no_interval, "no_interval", doubt, "how well the data determine the numbers could not be computed", "",
             "free fewer, or name a structure of fewer bodies"},
      Phrase{noise_hides_limit, "noise_hides_limit", doubt,
             "noise hides the response where the crossover limits, near {frequency:.4g} Hz (coherence "
             "{coherence:.2f}), and the other lines leave the critical stiffness open within a factor of {factor:.2g}",
             "", "excite more strongly there, or for longer"},
      Phrase{residual_beyond_noise, "residual_beyond_noise", doubt,
             "the structure leaves {unexplained:percent} of the response unexplained beyond the noise: friction, "
             "backlash, or a body that it lacks"},
      Phrase{residual_largest, "residual_largest", warning,
             "the structure leaves {unexplained:percent} of the response unexplained beyond the noise, most {?to|from "
             "{from:.4g} to {to:.4g} Hz}{!to|near {from:.4g} Hz}",
             "friction, backlash or a mode that the structure lacks; the intervals are widened for it, the values may "
             "be off by more"},
      Phrase{
          residual_stands_out, "residual_stands_out", doubt,
          "the fitted device leaves more than the noise of {source}, most from {from:.4g} to {to:.4g} s: what is left "
          "{?kind=correlated|is correlated with itself}{?kind=follows_force|follows the force, as a missing body or "
          "mode "
          "does}{?kind=nonlinear|follows the motion, as a nonlinear force does}{?kind=varies_with_speed|grows or falls "
          "with the speed}",
          "", "name a structure with what is missing, or excite less of it"},
      Phrase{residual_above_noise, "residual_above_noise", doubt,
             "what the structure leaves of the response is {residual:.2g} times its noise: friction, backlash, or a "
             "body that it lacks"},
      Phrase{residual_above_noise_in_band, "residual_above_noise_in_band", doubt,
             "from {lowest:.4g} to {highest:.4g} Hz what the structure leaves of the response is {residual:.2g} times "
             "its noise: friction, backlash, or a body that it lacks"},
      Phrase{residual_in_time_beyond_noise, "residual_in_time_beyond_noise", doubt,
             "the fitted device leaves {unexplained:percent} of the response of {source} unexplained beyond the noise: "
             "a body that it lacks, or backlash"},
      Phrase{residuals_larger_at_reversals, "residuals_larger_at_reversals", doubt,
             "the residuals of {source} are {ratio:.2g} times larger where the motion turns than elsewhere: the "
             "friction is not Coulomb's, or there is backlash"},
      Phrase{mode_missing, "mode_missing", doubt,
             "a mode near {frequency:.4g} Hz{?damping_ratio| (damping ratio about {damping_ratio:.2g})} is missing "
             "from the structure",
             "add a body and a link{?damping_ratio| for it, or leave that band out}"},
      Phrase{higher_order_explains_better, "higher_order_explains_better", doubt,
             "one body more, on {body} with a mode near {frequency:.3g} Hz, explains the record better ({residual:.3g} "
             "times the noise instead of {without:.3g}): the structure lacks a body, or the search ended beside the "
             "device",
             "", "name a structure with it"},
      Phrase{segments_truncate_mode, "segments_truncate_mode", doubt,
             "the mode near {frequency:.4g} Hz that limits rings on for {ringing:.3g} s, and the segments of the "
             "record are {segment:.3g} s long",
             "", "record for longer, or excite periodically"},
      Phrase{rectangular_window_leaks, "rectangular_window_leaks", doubt,
             "segments under a rectangular window leak from the strongest lines into all others", "", "take hann"},
      Phrase{recorded_in_feedback, "recorded_in_feedback", doubt,
             "the force of {source} answers to the noise of its position: recorded in feedback, where disturbances "
             "bias a fit by as much as they are of the force",
             "", "record with a force made beforehand"},
      Phrase{lag_beyond_drives, "lag_beyond_drives", doubt,
             "the actuator's lag comes out as {lag:.4g} s, {periods:.3g} sampling periods: it was probably exchanged "
             "with the time that a body's mass takes on its damping, or friction or a spring hides it",
             "", "name what is free without the lag"},
      Phrase{fitted_late_beyond_drives, "fitted_late_beyond_drives", warning,
             "delay and lag come to {late:.4g} s, {periods:.3g} sampling periods", "few drives are as slow as that",
             "are force and motion of the same instant, and the time in seconds? Else, is it in {likely_unit}? It must "
             "be in seconds: {likely:.4g}"},
      Phrase{fitted_body_too_heavy, "fitted_body_too_heavy", doubt,
             "{body} has {?mass|a mass of {mass:.4g} kg}{?inertia|an inertia of {inertia:.4g} kg m^2}: few haptic "
             "devices are as heavy as that",
             "", "are force and motion in SI units?"},
      Phrase{mass_far_from_structure, "mass_far_from_structure", doubt,
             "{key} comes out {ratio:.3g} times the structure's",
             "one of force, motion and structure is probably not in SI units",
             "{?prefix|is the motion or the force in {prefix} of its unit?}{!prefix|check their units}"},
      Phrase{period_far_from_record, "period_far_from_record", warning,
             "the structure's sampling period, {period:.4g} s, is {ratio:.3g} times the record's",
             "the critical stiffness is that of the structure's period",
             "{?prefix|is one of them in {prefix}seconds?}{!prefix|give the period of the loop to judge in seconds}"},
      Phrase{delay_lost, "delay_lost", doubt,
             "the record shows {lost} less delay than the structure states: rows that pair a force with a later "
             "position hide it, and the critical stiffness comes out too high",
             "", "log both at one instant, or correct loop.delay in the structure"},
      Phrase{delay_contradicts_structure, "delay_contradicts_structure", doubt,
             "the record shows a delay of {shown:.3g} s where the structure has {given:.3g} s",
             "the critical stiffness depends on it", "free loop.delay, or give it"},
      Phrase{delay_hidden, "delay_hidden", doubt,
             "the response has {lines:n} lines, too few to tell a delay beside the {numbers:n} numbers that are "
             "fitted, and a delay makes the critical stiffness lower",
             "", "excite more lines, or state loop.delay in a device file"},
      Phrase{delay_open, "delay_open", doubt,
             "no delay was to be fitted, and the record does not exclude one with which the critical stiffness is "
             "{stiffness:.3g} {unit}",
             "", "free loop.delay, state it in a device file, or excite higher frequencies"},
      Phrase{delay_not_shown, "delay_not_shown", doubt, "the delay from force to motion does not show in this record",
             "taken as half a period, that of a held force", "move at several frequencies"},
      Phrase{force_acts_later, "force_acts_later", note,
             "the force acts {milliseconds:.4g} ms later than a held force does",
             "the device has it as its loop.delay"},
      Phrase{fixed_parameter_inconsistent, "fixed_parameter_inconsistent", doubt,
             "{key} was not fitted, and the recordings contradict it: they ask for about {shown:.3g} where {given:.3g} "
             "is taken, in SI units",
             "", "free it too"},
      Phrase{operator_taken_to_hold, "operator_taken_to_hold", warning,
             "the structure's operator is taken to hold the device while it is recorded",
             "the bodies are fitted beside it, and the critical stiffness is with it",
             "leave the operator out where nobody held the device"},
      Phrase{nobody_taken_to_hold, "nobody_taken_to_hold", note,
             "nobody is taken to have held the device while it was recorded",
             "a hand's mass and damping would count as the device's own, and its critical stiffness come out 2 to 20 "
             "times too high",
             "record it alone"},
      Phrase{force_taken_for_command, "force_taken_for_command", note,
             "the force is taken for the one that was commanded at the instant of its row's position",
             "of a load cell's, or beside a later position, what delays the command (a bus, a drive) is not in the "
             "record, and the critical stiffness comes out up to several times too high",
             "record the command beside the position read before it, or add that delay as loop.delay"},
      Phrase{held_body_looks_held, "held_body_looks_held", doubt,
             "{body} comes out at least {of_mass:.2g} times as heavy and {of_damping:.2g} times as damped as in the "
             "structure: a hand on it would be in both, and in the critical stiffness",
             "", "record it with nobody on it, or correct the structure"},
      Phrase{spring_to_ground, "spring_to_ground", doubt,
             "the record shows a spring of about {stiffness:.3g} {unit} from {body} to the ground, which the structure "
             "does not have: a hand on it, a cable, or gravity",
             "", "record it with nobody on it, or give the body that stiffness"},
      Phrase{dry_friction_taken_for_damping, "dry_friction_taken_for_damping", doubt,
             "the record shows dry friction of about {force:.3g} {unit} on {body}",
             "the fit takes it for damping, which makes the critical stiffness too high",
             "fit the friction too, in time; or excite more strongly: its share falls with the amplitude"},
      Phrase{dry_friction_fitted, "dry_friction_fitted", note, "dry friction of {force:.3g} {unit} ({key})",
             "the critical stiffness is that of the device without it: small motion is damped by it"},
      Phrase{friction_shown_in_time, "friction_shown_in_time", doubt,
             "the record shows dry friction{?force| of about {force:.3g} {force_unit}} on {body}",
             "beside it the critical stiffness is about {stiffness:.3g} {unit}{?within_from|, within the interval}",
             "fit the friction too, in time; or excite more strongly: its share falls with the amplitude"},
      Phrase{friction_not_told_from_damping, "friction_not_told_from_damping", doubt,
             "the record does not tell damping from dry friction{?force| of about {force:.3g} {force_unit}} on "
             "{body}",
             "beside it the critical stiffness is about {stiffness:.3g} {unit}{?within_from|, within the interval}",
             "fit the friction too, in time; or excite more strongly: its share falls with the amplitude"},
      Phrase{friction_not_looked_for, "friction_not_looked_for", note, "dry friction was not looked for in time",
             "that takes {samples:n} samples, and a device that moves through each in {steps:n} steps or fewer; "
             "friction that the response does not show makes the critical stiffness too high",
             "record for longer; or fit a structure without the stiffest link"},
      Phrase{linear_fit_leaves_more, "linear_fit_leaves_more", doubt,
             "a linear fit of the same record leaves more than its noise, and no friction is found that explains it: a "
             "spring to the ground, or a body, that the structure lacks passes for noise",
             "", "name it"},
      Phrase{linear_fit_gives_less, "linear_fit_gives_less", doubt,
             "a linear fit of the same record gives {linear}, less than the fit with friction, which can only raise "
             "it: a spring to the ground, or a body, that the structure lacks passes for noise",
             "", "name it"},
      Phrase{constant_force, "constant_force", note,
             "a constant force of {force:.3g} {unit} beside the recorded one in {source}",
             "an offset of the actuator, gravity, or friction that differs by direction; the fit allows for it"},
      Phrase{recordings_disagree, "recordings_disagree", doubt,
             "the recordings disagree: {of_softest} alone gives a critical stiffness of {softest}, {of_stiffest} alone "
             "{stiffest}, beyond what their noise allows",
             "", "the device, its load or its friction has changed between them: look at them one by one"},
      Phrase{nonlinear_spring, "nonlinear_spring", doubt,
             "{source} shows a force that changes with the position, but not in proportion to it: a spring that "
             "stiffens, gravity on a lever, or a stop",
             taken_for, "record smaller motion, about the place that matters"},
      Phrase{nonlinear_actuator, "nonlinear_actuator", doubt,
             "{source} shows a force that is not in proportion to the recorded one: an amplifier that saturates, or a "
             "torque that falls at large currents",
             taken_for, "record the force that acts, or excite less strongly"},
      Phrase{cogging, "cogging", doubt,
             "{source} shows a force that comes and goes with the position, about every {wavelength:.2g} {unit}: "
             "cogging, gear teeth, or a bearing",
             taken_for, "compensate it, or excite more strongly: its share falls with the amplitude"},
      Phrase{drag, "drag", doubt,
             "{source} {?below|hardly tells damping from}{!below|shows} a force that is not in proportion to the "
             "speed: drag of air or of a fluid, an eddy-current brake, or friction that changes with the "
             "speed{?below|: beside it the critical stiffness is about {beside}}{!below|{?beside| (beside it the "
             "critical stiffness is about {beside})}}",
             taken_for,
             "record it at the speeds that matter: slow motion is damped less, and its critical stiffness is lower"},
      Phrase{friction_not_coulombs, "friction_not_coulombs", doubt,
             "{source} {?below|hardly tells damping from}{!below|shows} friction that is not Coulomb's as the motion "
             "turns: what rubs, or a cable, bends before it slips, or friction at rest is more{?below|: beside it the "
             "critical stiffness is about {beside}}{!below|{?beside| (beside it the critical stiffness is about "
             "{beside})}}",
             taken_for, "excite more strongly: its share falls with the amplitude"},
      Phrase{link_friction, "link_friction", doubt,
             "{source} {?below|hardly tells damping from}{!below|shows} friction in a link: a belt, cable or gear that "
             "rubs, or gives before it slips{?below|: beside it the critical stiffness is about "
             "{beside}}{!below|{?beside| (beside it the critical stiffness is about {beside})}}",
             taken_for, "excite more strongly: its share falls with the amplitude"},
      Phrase{unmodelled_mode, "unmodelled_mode", doubt,
             "{source} shows a mode near {frequency:.4g} Hz that the structure lacks, {?times|larger "
             "than}{?share|{share:percent} of} the response there{?beside|: with it the critical stiffness is about "
             "{beside}}",
             taken_for, "give the structure one more body (a frame that shakes is one), or hold the device firmly"},
      Phrase{delay_changes, "delay_changes", doubt,
             "{source} shows a delay that changes by {change} from its beginning to its end: the clocks of force and "
             "position run apart, or under a sweep something delays some frequencies more than others",
             taken_for, "record both by one clock, under noise or a multisine"},
      Phrase{damping_changes, "damping_changes", doubt,
             "{source} shows that the damping of {body} changes by {change} while it is recorded, of which the fit is "
             "a mean: at the softest the critical stiffness is about {beside} or less",
             taken_for, "record the device when it is warm, or as cold as it will be used"},
      Phrase{taken_as_zero, "taken_as_zero", warning, "{key} = {value:.4g} is below 0", "taken as 0 in the device"},
      Phrase{friction_below_zero, "friction_below_zero", doubt,
             "{friction} friction comes out as {value:.3g}, below 0 by more than its interval: motion is too noisy, or "
             "another force acts",
             "", "lower the cutoff, or fit in time"},
      Phrase{force_unexplained, "force_unexplained", refusal,
             "{unexplained:percent} of the force stays unexplained by one rigid body with dry friction",
             "its parameters may be off by more than their intervals",
             "lower the cutoff below the first vibration mode, or fit a structure of several bodies"},
      Phrase{device_not_rigid, "device_not_rigid", doubt,
             "the device is not rigid: {?first_mode|its response turns back near {first_mode:.4g} Hz}{?mode_above|its "
             "inertia changes with frequency, as below a mode near {mode_above:.2g} Hz}",
             "a mode may limit the wall before the rigid body does",
             "fit a structure of several bodies to judge walls"}};
  return phrases;
}

}  // namespace zwidth::internal
