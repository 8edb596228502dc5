#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> identification_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  // What leaves most of an interval open.
  static constexpr const char* rival_leaves_open =
      "{?rival|most of it by {?rival=coulomb_friction|dry friction}{?rival=drag|a force that grows with the square of "
      "the speed}{?rival=damping_drift|a damping that "
      "changes while it is recorded}{?rival=delay_drift|clocks that run apart}{?rival=presliding|friction that bends "
      "before it slides}{?rival=link_friction|dry friction between two bodies}{?rival=link_presliding|friction between "
      "two bodies that bends before it slides}{?rival=stiffening_spring|a spring that stiffens}{?rival=actuator_lag|a "
      "lag of the "
      "actuator}{?rival=ground_spring|a spring to the "
      "ground}{?rival=drive_saturation|a drive that saturates}{?rival=drive_dead_band|a dead band of the "
      "drive}{?rival=constant_force|a constant force} ({parameter}), within which it is {with_lower} to {with_upper}}";
  static constexpr const char* record_against_rival =
      "{?rival=coulomb_friction|record at a second, larger amplitude}{?rival=drag|record at a second amplitude}"
      "{?rival=damping_drift|record the device when it is warm}"
      "{?rival=delay_drift|record both by one clock}{?rival=presliding|record larger "
      "motion}{?rival=link_friction|record at a second, larger amplitude}{?rival=link_presliding|record larger "
      "motion}{?rival=stiffening_spring|record at a second amplitude}{?rival=actuator_lag|excite higher "
      "frequencies}{?rival=ground_spring|excite lower frequencies}"
      "{?rival=drive_saturation|record with less force}{?rival=drive_dead_band|record with more force}"
      "{?rival=constant_force|record for longer}"
      "{!rival|excite more strongly or for longer{?delay_within_ms|, and at higher frequencies}}";
  static constexpr std::array phrases{
      Phrase{motion_against_force, "motion_against_force", refusal,
             "the position falls as the force rises: scale one of them by -1"},
      Phrase{nothing_determined, "nothing_determined", refusal,
             "the {?by=record|record determines}{?by=recordings|recordings determine} no parameter of the structure",
             "", "free fewer, or excite more strongly"},
      Phrase{parameter_unidentifiable, "parameter_unidentifiable", warning, "the response says nothing about {key}",
             "it stays near the structure's value, without an interval"},
      Phrase{only_combination_identifiable, "only_combination_identifiable", warning,
             "the response determines only a combination of {keys}",
             "they stay as near the structure's values as the data allow, without an interval"},
      Phrase{parameter_hardly_determined, "parameter_hardly_determined", warning,
             "{key} is known to {relative_deviation:percent} only (one standard deviation)",
             "the data hardly determine it"},
      Phrase{search_stopped, "search_stopped", doubt,
             "the search for the parameters was stopped while its steps still moved the critical stiffness by "
             "{moved:percent}",
             "the interval may be too narrow", "free fewer parameters, or start from values that are nearly right"},
      Phrase{motion_tells_no_limit, "motion_tells_no_limit", doubt,
             "the motion tells of no critical stiffness: friction and drag explain its damping, or no device of the "
             "structure plays it",
             "the answer is that of the lines of its response, which take friction and drag for damping; that of small "
             "motion may be lower",
             "record at several times the force and give both, or free fewer parameters"},
      Phrase{limit_outside_band, "limit_outside_band", doubt,
             "the crossover that limits, near {frequency:.4g} Hz, lies {side} the measured band, {lowest:.4g} to "
             "{highest:.4g} Hz: {?side=above|delay, lag and modes there are not in the data; excite higher "
             "frequencies}{?side=below|dampings and springs there are not in the data; excite lower frequencies}"},
      Phrase{data_leave_interval_open, "data_leave_interval_open", doubt,
             "{?delay_within_ms|the delay is known to +-{delay_within_ms:.2g} ms only: }the data leave the critical "
             "stiffness open {?factor|within a factor of {factor:.2g}}{?more_than|by more "
             "than a factor of {more_than:.0f}}{!factor|{!more_than|down to 0, where not even the softest wall is "
             "stable}}",
             rival_leaves_open, record_against_rival},
      Phrase{residual_stands_out, "residual_stands_out", doubt,
             "the fitted device leaves more than the noise of {source}{?to|, most from {from:.4g} to {to:.4g} s}: what "
             "is left {?kind=follows_force|follows the force, as a missing body or mode "
             "does}{?kind=nonlinear|follows the motion, as a nonlinear force does}{?kind=records_differ|would be less "
             "with numbers "
             "of its own in each record}{?kind=given|would be less with another "
             "{number} than the "
             "given one, {shown:.4g} in place of {given:.4g}}",
             "the critical stiffness may lie outside its interval",
             "{?kind=follows_force|name a structure with one more body, or excite no higher than it "
             "holds}{?kind=nonlinear|excite at two amplitudes, and record smaller motion}{?kind=records_differ|record "
             "one device "
             "in one state, or identify each record alone}{?kind=given|free {number}, or "
             "measure it}"},
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
      Phrase{delay_contradicts_structure, "delay_contradicts_structure", doubt,
             "the record shows a delay of {shown:.3g} s where the structure has {given:.3g} s",
             "the critical stiffness depends on it", "free loop.delay, or give it"},
      Phrase{delay_not_shown, "delay_not_shown", doubt, "the delay from force to motion does not show in this record",
             "taken as half a period, that of a held force", "move at several frequencies"},
      Phrase{force_acts_later, "force_acts_later", note,
             "the force acts {milliseconds:.4g} ms later than a held force does",
             "the device has it as its loop.delay"},
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
      Phrase{rows_fitted_in_part, "rows_fitted_in_part", note,
             "the recordings are long: {share:percent} of their rows, spread evenly over each, are fitted"},
      Phrase{force_of_one_size, "force_of_one_size", note,
             "the force has one size: a drive that saturates or has a dead band passes for one of another gain",
             "the critical stiffness is wrong by as much", "record a force of several sizes: a multisine, a sweep"},
      Phrase{further_body_fitted, "further_body_fitted", note,
             "the motion shows a body that the structure lacks: {mass:.3g} {unit}, at {frequency:.4g} Hz against "
             "{behind}; it is fitted as {body}, linked to {behind}",
             "limits with a user hang on which of the two is held", "name both in the structure"},
      Phrase{dry_friction_fitted, "dry_friction_fitted", note,
             "dry friction of {force:.3g} +- {deviation:.2g} {unit} {?body|on {body}}{?link|in link {link}}",
             "the critical stiffness is that of the device without it: small motion is damped by it"},
      Phrase{constant_force, "constant_force", note,
             "a constant force of {force:.3g} +- {deviation:.2g} {unit} beside the recorded one in {source}",
             "an offset of the actuator, gravity, or friction that differs by direction; the fit allows for it"},
      Phrase{taken_as_zero, "taken_as_zero", warning, "{key} = {value:.4g} is below 0", "taken as 0 in the device"},
      Phrase{friction_below_zero, "friction_below_zero", doubt,
             "{friction} friction comes out as {value:.3g}, below 0 by more than its interval: motion is too noisy, or "
             "another force acts",
             "", "lower the cutoff, or identify the device from its motion"},
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
