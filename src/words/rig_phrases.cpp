#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {
namespace {

constexpr const char* cycles_late = "cycles may come late when the machine is busy";

}  // namespace

std::span<const Phrase> rig_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  static constexpr std::array phrases{
      Phrase{interrupted, "interrupted", warning, "interrupted: the force is zero"},
      Phrase{position_not_a_number, "position_not_a_number", warning,
             "a position or a force was not a number: the force is zero; check the sensor and the wall's filters"},
      Phrase{beyond_position_limit, "beyond_position_limit", warning,
             "the position went beyond its limit: the force is zero; render softer, or allow more"},
      Phrase{beyond_velocity_limit, "beyond_velocity_limit", warning,
             "the velocity went beyond its limit: the force is zero; render softer, or allow more"},
      Phrase{force_limited_too_long, "force_limited_too_long", warning,
             "more force was wanted than is allowed, for too long: the force is zero; render softer, or allow more"},
      Phrase{missed_cycles, "missed_cycles", warning,
             "too many cycles in a row came late: the force is zero; give the loop a processor of its own and "
             "real-time priority, or a longer sampling period"},
      Phrase{lost_link, "lost_link", warning,
             "too many cycles in a row brought no position: the force is zero; check cable, port and baud rate"},
      Phrase{drive_in_trouble, "drive_in_trouble", warning,
             "there was no position any more: the force is zero; {trouble}"},
      Phrase{watchdog_fired, "watchdog_fired", warning,
             "the loop stood still and the watchdog set the force to zero; give it a processor of its own and "
             "real-time priority"},
      Phrase{oscillation_grew, "oscillation_grew", warning, "an oscillation grew: the force is zero; render softer"},
      Phrase{moves_against_force, "moves_against_force", refusal,
             "the device moved against the force: by {moved} under {force}: a wall would push it away", "",
             "{?mending_force_sign|set driver.force_sign to {mending_force_sign:n} where the position counts the right "
             "way, driver.sign and driver.force_sign both the other way round where the force pushes the right way}"
             "{!mending_force_sign|turn the force or the position round in the drive}"},
      Phrase{moves_under_no_force, "moves_under_no_force", refusal,
             "the device did not move with the nudge of {force} so that the drive's sign is known", "",
             "free it, or state its dry friction (body.coulomb), against which the nudge is made; where its amplitude "
             "was given, give more; where the sign is known, leave the nudge out"},
      Phrase{cycles_unanswered, "cycles_unanswered", doubt,
             "{share:%.2f} % of the cycles brought no position, and their force came a period late{?error|: the limit "
             "may be {error:%.1f} % lower by that}",
             "", "a better cable, a shorter line or a longer sampling period"},
      Phrase{drive_limits_force, "drive_limits_force", warning,
             "the drive itself limits the force to {drive_limit}, below the force limit of {force_limit}: beyond it "
             "walls are softer than they seem",
             "", "raise the limit in the drive, or lower the force limit"},
      Phrase{drive_drops_small_forces, "drive_drops_small_forces", warning,
             "the drive gives no force below {force}: it makes no current below {current} (cc_min_current)",
             "oscillations smaller than that are not seen to grow, nor are walls felt at a light touch",
             "set the drive's minimum current to less, or 0, and knock harder"},
      Phrase{
          drive_filters_position, "drive_filters_position", warning,
          "{?bandwidth|the drive filters the position that it tells, {?assumed|unless that was changed }at "
          "{bandwidth:.4g} rad/s}"
          "{?lag|the drive filters the position that it tells, with a time constant of {lag:time}}"
          "{?of_file|; its file says {of_file:.4g} {?bandwidth|rad/s}{?lag|s}}{!of_file|, of which its file says "
          "nothing}",
          "limits predicted without it are too high",
          "{?bandwidth|set sensor.tracking_bandwidth to {bandwidth:.4g}}{?lag|set actuator.time_constant, which acts "
          "in the loop as it does, to {lag:.3g} s or more}"},
      Phrase{drive_settings_unknown, "drive_settings_unknown", warning,
             "the settings of the drive's firmware {firmware} are not known here: its minimum current (cc_min_current) "
             "and division of the angle (p_pid_ang_div) were not read",
             "the position may be a part of the motor's, and small forces may be dropped",
             "see in VESC Tool that the division is 1 and the minimum current small"},
      Phrase{
          drive_after_watchdog, "drive_after_watchdog", note,
          "once its watchdog has let go the drive {?mode=0|switches the motor off}{?mode=12|brings the motor to rest "
          "with its own gain of velocity}{?mode=15|shorts the motor}{!mode=0|{!mode=12|{!mode=15|goes on in mode "
          "{mode:n}}}} (servo.timeout_mode)"},
      Phrase{memory_not_locked, "memory_not_locked", warning, "memory could not be locked: {error}", cycles_late,
             "raise the limit: ulimit -l unlimited, or memlock in limits.conf"},
      Phrase{no_real_time_priority, "no_real_time_priority", warning, "real-time priority is not allowed: {error}",
             cycles_late, "allow it: rtprio 99 in /etc/security/limits.conf, or CAP_SYS_NICE for the program"},
      Phrase{no_processor_of_its_own, "no_processor_of_its_own", warning,
             "the loop has no processor of its own: {error}", cycles_late, "start it with taskset"},
      Phrase{check_cut_short, "check_cut_short", refusal, "the rig stopped before the check was over: {reason}"},
      Phrase{first_trial_cut_short, "first_trial_cut_short", refusal, "the rig stopped in the first trial: {reason}"},
      Phrase{search_cut_short, "search_cut_short", refusal, "the rig stopped before an oscillation grew: {reason}"},
      Phrase{record_cut_short, "record_cut_short", refusal, "the rig stopped before its record was whole: {reason}"},
      Phrase{wall_cut_short, "wall_cut_short", doubt, "the rig stopped before the wall's time was over: {reason}"},
      Phrase{force_kept_back, "force_kept_back", doubt,
             "force was kept back for {duration}, by its limit or its ramp: the wall that was felt is softer than this "
             "one"},
      Phrase{position_never_changed, "position_never_changed", doubt,
             "the position never changed under force: check encoder, [driver], and that the drive moves its motor"},
      Phrase{unstable_and_stopped, "unstable_and_stopped", doubt,
             "the wall is UNSTABLE by linear analysis, {holders}: render softer"},
      Phrase{
          unstable_growing_slowly, "unstable_growing_slowly", doubt,
          "the wall is UNSTABLE by linear analysis, {holders}: that its oscillation grew too slowly to be taken away "
          "does not make it stable",
          "", "render softer"},
      Phrase{unstable_unseen, "unstable_unseen", doubt,
             "the wall is UNSTABLE by linear analysis, {holders}: that no oscillation was seen to grow while it ran "
             "does not make it stable",
             "", "render softer"},
      Phrase{stable_wall_oscillates, "stable_wall_oscillates", doubt,
             "an oscillation grew in a wall that is stable by linear analysis: the device is not that of its file", "",
             "identify it, and render softer until then"},
      Phrase{device_bears_less, "device_bears_less", warning,
             "UNSAFE: the device bears less than its file promises: {at_most} at most, as measured, for "
             "{promised:limit}",
             "walls in between are called stable, and shake on the device",
             "identify the device, and render softer until then"},
      Phrase{prediction_above_measured, "prediction_above_measured", doubt,
             "the device on the rig bears {at_most} at most, less than this: its file is not that of the device", "",
             "identify it"},
      Phrase{file_promises_more, "file_promises_more", doubt,
             "the device's file promises {promised:limit}, more than was measured: identify the device before any of "
             "its limits is used"},
      Phrase{measured_below_promise, "measured_below_promise", warning,
             "the limit measured, {measured}, lies {difference:%} % below the {promised:limit} that the device's file "
             "promises, if not surely",
             "walls in between are called stable, and may shake on the device",
             "measure again, harder or for longer; identify the device, and render softer until then"},
      Phrase{measured_above_promise, "measured_above_promise", note,
             "the limit measured, {measured}, lies {difference:%} % above the {promised:limit} that the device's file "
             "promises: the file is not that of the device",
             "", "identify it"},
      Phrase{
          user_was_not_there, "user_was_not_there", note,
          "the limit measured, {at_most} at most, lies below that with the file's user, {with_user:limit}, not below "
          "that with nobody holding, {with_nobody:limit}",
          "whoever held the device, if anybody did, was not the file's user",
          "leave the user out of the file for a rig that nobody holds"},
      Phrase{friction_in_response, "friction_in_response", doubt,
             "the device has dry friction, which a response shows as damping: large motion has less of it, and a lower "
             "limit",
             "", "excite more strongly and see whether the limit falls"},
      Phrase{force_cut_off, "force_cut_off", refusal,
             "the force was cut off after the knock, so that the walls that were felt are not those that were tried: "
             "allow more force, or knock softer"},
      Phrase{no_trial_ended, "no_trial_ended", refusal, "no trial came to its end"},
      Phrase{no_oscillation_grew, "no_oscillation_grew", refusal,
             "no oscillation grew up to {stiffness}: raise the ceiling, or knock harder"},
      Phrase{every_wall_oscillates, "every_wall_oscillates", refusal,
             "an oscillation grew with every wall, down to {stiffness}: check sign and units of the drive"},
      Phrase{growth_not_bracketed, "growth_not_bracketed", doubt,
             "no oscillation was read that decays below the limit and grows above it: softer walls may grow unseen", "",
             "let the trials last longer, or knock harder"},
      Phrase{encoder_coarse_for_swing, "encoder_coarse_for_swing", doubt,
             "the encoder's step of {resolution} is coarse for a swing of {swing}: the limit may be off by {error:%} %",
             "", "knock harder"},
      Phrase{growth_not_known, "growth_not_known", doubt,
             "the oscillation's growth is not known well enough: the limit may be off by {error:%} %", "",
             "knock harder"},
      Phrase{growth_not_told, "growth_not_told", doubt,
             "whether an oscillation grows in walls of {softest} to {stiffest}, softer than the limit, cannot be told: "
             "its growth is not known well enough",
             "", "knock harder, or let the trials last longer"},
      Phrase{no_smaller_impulse, "no_smaller_impulse", doubt,
             "no smaller knock was tried, which would show whether the limit is that of this swing alone"},
      Phrase{
          smaller_impulse_not_read, "smaller_impulse_not_read", doubt,
          "after a knock of half the size no oscillation was read: the limit may be that of this swing alone, as dry "
          "friction or a coarse encoder makes it",
          "", "knock harder"},
      Phrase{
          smaller_swing_decays_faster, "smaller_swing_decays_faster", doubt,
          "after a knock of half the size the oscillation decays faster, as friction or play in the device makes it: "
          "the limit of another swing may be {error:%} % lower",
          "", "knock harder and see whether the limit falls"},
      Phrase{smaller_swing_decays_less, "smaller_swing_decays_less", doubt,
             "after a knock of half the size the oscillation decays less, as friction or play in the device makes it: "
             "the limit of another swing may be {error:%} % lower",
             "", "knock harder and see whether the limit falls"},
      Phrase{bracket_wide, "bracket_wide", doubt,
             "the limit lies between {lower} and {upper}: the search ended before it was closer"},
      Phrase{friction_holds_swing, "friction_holds_swing", doubt,
             "dry friction holds small swings down: the limit is that of the swing after the knock", "",
             "knock harder for the limit of large motion"}};
  return phrases;
}

}  // namespace zwidth::internal
