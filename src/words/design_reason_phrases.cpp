#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> design_reason_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  static constexpr std::array phrases{
      Phrase{no_stiffness_too_much, "no_stiffness_too_much", note,
             "no stiffness is too much for this device: its force does not move what is sensed"},
      Phrase{no_damping_too_much, "no_damping_too_much", note,
             "no damping is too much for this device: its force does not move what is sensed"},
      Phrase{every_wall_destabilised, "every_wall_destabilised", note,
             "some passive user destabilises any wall, however soft: nothing damps a motion that the user can drive "
             "(the device's own damping, not the wall's, is what bears a user)"},
      Phrase{every_damper_destabilised, "every_damper_destabilised", note,
             "some passive user destabilises any damper, however weak: nothing damps a motion that the user can drive"},
      Phrase{hardly_any_wall_keeps_margins, "hardly_any_wall_keeps_margins", note,
             "with some passive user no wall stiffer than {stiffness} keeps the margins asked: hardly anything damps a "
             "motion that the user can drive (the device's own damping, not the wall's, is what bears a user)"},
      Phrase{no_wall_stable_with_any_damper, "no_wall_stable_with_any_damper", note,
             "no wall is stable from K = 0 on, with any damper tried"},
      Phrase{no_damper_stable, "no_damper_stable", note, "no damper is stable from B = 0 on"},
      Phrase{no_wall_with_damped_contact, "no_wall_with_damped_contact", note,
             "no wall keeps the margins asked without a swinging contact"},
      Phrase{no_wall_keeps_margins_with_any_filter, "no_wall_keeps_margins_with_any_filter", note,
             "no wall keeps the margins asked, with any damper and velocity filter tried", "",
             "ask for less phase margin"},
      Phrase{lower_end_leaves_no_margins, "lower_end_leaves_no_margins", note,
             "at the lower end of the uncertainty no wall keeps the margins asked"},
      Phrase{uncertainty_leaves_no_margins, "uncertainty_leaves_no_margins", note,
             "the uncertainty of the device leaves no wall: in more than {threshold:%.1f} % of the devices drawn from "
             "it none keeps what is asked",
             "", "identify the device from more or longer recordings"},
      Phrase{uncertainty_leaves_no_damper, "uncertainty_leaves_no_damper", note,
             "the uncertainty of the device leaves no damper"},
      Phrase{drift_leaves_no_wall, "drift_leaves_no_wall", note,
             "the drift of the modes leaves no wall: at some drift none keeps what is asked"},
      Phrase{drift_leaves_no_damper, "drift_leaves_no_damper", note, "the drift of the modes leaves no damper"},
      Phrase{notch_lowers_any_user_limit, "notch_lowers_any_user_limit", note,
             "the notch lowers the limit with any user at some drift of the modes"},
      Phrase{largest_damper_unknown, "largest_damper_unknown", note, "the largest damper alone is not known"},
      Phrase{no_damper_too_large, "no_damper_too_large", note, "no damper is too large"},
      Phrase{device_refused, "device_refused", note, "the device is refused"},
      Phrase{too_many_bodies_for_wall_summary, "too_many_bodies_for_wall_summary", note,
             "takes long for {bodies:n} bodies"},
      Phrase{limit_refused_at_value, "limit_refused_at_value", note,
             "the limit at the value found is refused: {reason}"},
      Phrase{limit_jumps_across_target, "limit_jumps_across_target", note,
             "the limit jumps across the target there: another mechanism takes over"},
      Phrase{any_user_limit_at_target, "any_user_limit_at_target", note,
             "the limit with any passive user is the target there"},
      Phrase{rigid_body_limit_at_target, "rigid_body_limit_at_target", note,
             "the limit is the target there, set by the rigid body"},
      Phrase{mode_limit_at_target, "mode_limit_at_target", note,
             "the limit is the target there, set by vibration mode {mode:n}"},
      Phrase{stable_at_every_value, "stable_at_every_value", note, "every {what} is stable whatever it is"},
      Phrase{limit_stays_below_target, "limit_stays_below_target", note,
             "{?factor|within a factor of {factor:g} of its value}{!factor|at any value from 0 up to what is likely} "
             "the limit gets no higher than {limit:gain}"},
      Phrase{limit_stays_above_target, "limit_stays_above_target", note,
             "{?factor|within a factor of {factor:g} of its value}{!factor|at any value from 0 up to what is likely} "
             "the limit gets no lower than {limit:gain}"},
      Phrase{number_not_followed, "number_not_followed", note,
             "not followed: of so many bodies only the numbers are that move the limit most in a first step"},
      Phrase{no_crossover, "no_crossover", note, "no stiffness puts a pole on the unit circle"},
      Phrase{
          crossover_at_frequency, "crossover_at_frequency", note,
          "a phase crossover at {frequency_hz}: unstable from {gain:gain} on{?softest|, but walls from "
          "{softest:gain} on already oscillate at {softest_hz}}{?without_operator|; it does so without the user too}"},
      Phrase{loop_stable, "loop_stable", note, "the loop is stable with this wall"},
      Phrase{loop_unstable, "loop_unstable", note,
             "the loop is unstable with this wall: it grows at {frequency_hz}{?settles_elsewhere|, and where a force "
             "limit, a wall that only pushes or a hand lets it settle may be elsewhere}{?without_operator|; it does so "
             "without the user too}{?user_stabilises| once the file's user lets go, who keeps it stable}"},
      Phrase{no_user_destabilises_wall, "no_user_destabilises_wall", note,
             "no passive user can make a wall of any stiffness oscillate there"},
      Phrase{no_user_destabilises_damper, "no_user_destabilises_damper", note,
             "no passive user can make any damper oscillate there"},
      Phrase{some_user_destabilises, "some_user_destabilises", note,
             "some passive user can make {what}s from {gain:gain} on oscillate {?frequency_hz|at "
             "{frequency_hz}}{!frequency_hz|there}{?with_nobody|; this one oscillates with nobody holding}"},
      Phrase{unstable_without_steps, "unstable_without_steps", note,
             "the loop is unstable without the encoder's steps"},
      Phrase{no_crossover_for_steps, "no_crossover_for_steps", note,
             "the loop has no phase crossover above its gain for the steps to swing at"},
      Phrase{friction_holds_against_steps, "friction_holds_against_steps", note,
             "friction of {friction} holds against half a step's force of {force}"},
      Phrase{swing_beyond_steps, "swing_beyond_steps", note,
             "it swings by {amplitude}, more than steps of {resolution} keep up at this frequency, {threshold}"},
      Phrase{cycle_of_steps, "cycle_of_steps", note,
             "at rest between two steps the encoder is a relay: a cycle at the phase crossover {frequency_hz}"},
      Phrase{resonance_of_steps, "resonance_of_steps", note,
             "the loop resonates: an error within half a step keeps up swings of up to {amplitude} there"},
      Phrase{friction_destabilises_nothing, "friction_destabilises_nothing", note,
             "friction that holds a body still makes no stable loop unstable"},
      Phrase{friction_cycle_of_other_swing, "friction_cycle_of_other_swing", note,
             "its cycle at {frequency_hz} would swing by {amplitude}, not by {observed}"},
      Phrase{friction_cycle, "friction_cycle", note,
             "the loop is stable with its bodies sliding by this little and unstable where friction holds them: a "
             "cycle at about {frequency_hz}"}};
  return phrases;
}

}  // namespace zwidth::internal
