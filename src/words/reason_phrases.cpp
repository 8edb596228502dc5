#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> reason_phrases() {
  using enum FindingCode;
  static constexpr std::array phrases{
      Phrase{no_stiffness_too_much, "no_stiffness_too_much",
             "no stiffness is too much for this device: its force does not move what is sensed"},
      Phrase{no_damping_too_much, "no_damping_too_much",
             "no damping is too much for this device: its force does not move what is sensed"},
      Phrase{every_wall_destabilised, "every_wall_destabilised",
             "some passive user destabilises any wall, however soft: nothing damps a motion that the user can drive "
             "(the device's own damping, not the wall's, is what bears a user)"},
      Phrase{every_damper_destabilised, "every_damper_destabilised",
             "some passive user destabilises any damper, however weak: nothing damps a motion that the user can drive"},
      Phrase{hardly_any_wall_keeps_margins, "hardly_any_wall_keeps_margins",
             "with some passive user no wall stiffer than {stiffness} keeps the margins asked: hardly anything damps a "
             "motion that the user can drive (the device's own damping, not the wall's, is what bears a user)"},
      Phrase{no_wall_stable_with_any_damper, "no_wall_stable_with_any_damper",
             "no wall is stable from K = 0 on, with any damper tried"},
      Phrase{no_damper_stable, "no_damper_stable", "no damper is stable from B = 0 on"},
      Phrase{no_wall_with_damped_contact, "no_wall_with_damped_contact",
             "no wall keeps the margins asked without a swinging contact"},
      Phrase{no_wall_keeps_margins_with_any_filter, "no_wall_keeps_margins_with_any_filter",
             "no wall keeps the margins asked, with any damper and velocity filter tried", "",
             "ask for less phase margin"},
      Phrase{lower_end_leaves_no_margins, "lower_end_leaves_no_margins",
             "at the lower end of the uncertainty no wall keeps the margins asked"},
      Phrase{uncertainty_leaves_no_margins, "uncertainty_leaves_no_margins",
             "the uncertainty of the device leaves no wall: in more than {threshold:%.1f} % of the devices drawn from "
             "it none keeps what is asked",
             "", "identify the device from more or longer recordings"},
      Phrase{uncertainty_leaves_no_damper, "uncertainty_leaves_no_damper",
             "the uncertainty of the device leaves no damper"},
      Phrase{drift_leaves_no_wall, "drift_leaves_no_wall",
             "the drift of the modes leaves no wall: at some drift none keeps what is asked"},
      Phrase{drift_leaves_no_damper, "drift_leaves_no_damper", "the drift of the modes leaves no damper"},
      Phrase{notch_lowers_any_user_limit, "notch_lowers_any_user_limit",
             "the notch lowers the limit with any user at some drift of the modes"},
      Phrase{largest_damper_unknown, "largest_damper_unknown", "the largest damper alone is not known"},
      Phrase{no_damper_too_large, "no_damper_too_large", "no damper is too large"},
      Phrase{device_refused, "device_refused", "the device is refused"},
      Phrase{too_many_bodies_for_wall_summary, "too_many_bodies_for_wall_summary", "takes long for {bodies:n} bodies"},
      Phrase{limit_refused_at_value, "limit_refused_at_value", "the limit at the value found is refused: {reason}"},
      Phrase{limit_jumps_across_target, "limit_jumps_across_target",
             "the limit jumps across the target there: another mechanism takes over"},
      Phrase{any_user_limit_at_target, "any_user_limit_at_target",
             "the limit with any passive user is the target there"},
      Phrase{rigid_body_limit_at_target, "rigid_body_limit_at_target",
             "the limit is the target there, set by the rigid body"},
      Phrase{mode_limit_at_target, "mode_limit_at_target",
             "the limit is the target there, set by vibration mode {mode:n}"},
      Phrase{stable_at_every_value, "stable_at_every_value", "every {what} is stable whatever it is"},
      Phrase{limit_stays_below_target, "limit_stays_below_target",
             "{?factor|within a factor of {factor:g} of its value}{!factor|at any value from 0 up to what is likely} "
             "the limit gets no higher than {limit:gain}"},
      Phrase{limit_stays_above_target, "limit_stays_above_target",
             "{?factor|within a factor of {factor:g} of its value}{!factor|at any value from 0 up to what is likely} "
             "the limit gets no lower than {limit:gain}"},
      Phrase{number_not_followed, "number_not_followed",
             "not followed: of so many bodies only the numbers are that move the limit most in a first step"},
      Phrase{no_crossover, "no_crossover", "no stiffness puts a pole on the unit circle"},
      Phrase{crossover_at_frequency, "crossover_at_frequency",
             "a phase crossover at {frequency_hz}: unstable from {gain:gain} on{?softest|, but walls from "
             "{softest:gain} on already oscillate at {softest_hz}}{?without_operator|; it does so without the operator "
             "too}"},
      Phrase{loop_stable, "loop_stable", "the loop is stable with this wall"},
      Phrase{loop_unstable, "loop_unstable",
             "the loop is unstable with this wall: it grows at {frequency_hz}{?settles_elsewhere|, and where a force "
             "limit, a wall that only pushes or a hand lets it settle may be elsewhere}{?without_operator|; it does so "
             "without the operator too}{?user_stabilises| once the file's user lets go, who keeps it stable}"},
      Phrase{no_user_destabilises_wall, "no_user_destabilises_wall",
             "no passive user can make a wall of any stiffness oscillate there"},
      Phrase{no_user_destabilises_damper, "no_user_destabilises_damper",
             "no passive user can make any damper oscillate there"},
      Phrase{some_user_destabilises, "some_user_destabilises",
             "some passive user can make {what}s from {gain:gain} on oscillate {?frequency_hz|at "
             "{frequency_hz}}{!frequency_hz|there}{?with_nobody|; this one oscillates with nobody holding}"},
      Phrase{unstable_without_steps, "unstable_without_steps", "the loop is unstable without the encoder's steps"},
      Phrase{no_crossover_for_steps, "no_crossover_for_steps",
             "the loop has no phase crossover above its gain for the steps to swing at"},
      Phrase{friction_holds_against_steps, "friction_holds_against_steps",
             "friction of {friction} holds against half a step's force of {force}"},
      Phrase{swing_beyond_steps, "swing_beyond_steps",
             "it swings by {amplitude}, more than steps of {resolution} keep up at this frequency, {threshold}"},
      Phrase{cycle_of_steps, "cycle_of_steps",
             "at rest between two steps the encoder is a relay: a cycle at the phase crossover {frequency_hz}"},
      Phrase{resonance_of_steps, "resonance_of_steps",
             "the loop resonates: an error within half a step keeps up swings of up to {amplitude} there"},
      Phrase{friction_destabilises_nothing, "friction_destabilises_nothing",
             "friction that holds a body still makes no stable loop unstable"},
      Phrase{friction_cycle_of_other_swing, "friction_cycle_of_other_swing",
             "its cycle at {frequency_hz} would swing by {amplitude}, not by {observed}"},
      Phrase{friction_cycle, "friction_cycle",
             "the loop is stable with its bodies sliding by this little and unstable where friction holds them: a "
             "cycle at about {frequency_hz}"}};
  return phrases;
}

}  // namespace zwidth::internal
