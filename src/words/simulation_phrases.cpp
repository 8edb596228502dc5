#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {
namespace {

constexpr const char* ripple =
    "the encoder's steps of {resolution} make the force ripple by {force_amplitude} either way, at {frequency} on "
    "average";
constexpr const char* ripple_at_rest = "the force changes though the device hardly moves";
constexpr const char* ripple_in_drift = "it comes with slow motion, though nothing oscillates";
constexpr const char* quiet_damper = "a finer encoder, a low-pass on the wall's velocity, or less wall.damping";
constexpr const char* never_moves = "the device never moves: its friction of {friction} holds it where it starts";
constexpr const char* no_verdict = "the verdict says nothing about the wall";

}  // namespace

std::span<const Phrase> simulation_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  static constexpr std::array phrases{
      Phrase{start_inside_stiction, "start_inside_stiction", note,
             "a start {usual_start} inside the wall would be inside the stiction: {wall_force} pull there, {friction} "
             "hold",
             "the device starts {start} inside the wall instead"},
      Phrase{start_unseen_by_encoder, "start_unseen_by_encoder", note,
             "a start {usual_start} inside the wall would be less than the encoder sees",
             "the device starts {start} inside the wall instead"},
      Phrase{no_wall, "no_wall", note, "there is no wall: the device moves freely", "",
             "set wall.stiffness to render one"},
      Phrase{never_touches_wall, "never_touches_wall", warning, "the device never touches the wall",
             "the verdict is about the free device"},
      Phrase{starts_inside_wall, "starts_inside_wall", note, "the device starts {depth} inside the wall",
             "the wall pushes it out"},
      Phrase{never_moves_when_pushed, "never_moves_when_pushed", warning, never_moves, no_verdict, "push harder"},
      Phrase{never_moves_from_start, "never_moves_from_start", warning, never_moves, no_verdict,
             "start further out, {start} from the wall's surface"},
      Phrase{never_moves_under_force_limit, "never_moves_under_force_limit", warning, never_moves, no_verdict,
             "a force limit above the friction"},
      Phrase{force_limit_below_friction, "force_limit_below_friction", warning,
             "the actuator's {force_limit} are less than the friction of {friction}: no wall moves the device",
             no_verdict, "a force limit above the friction"},
      Phrase{encoder_stands_still, "encoder_stands_still", warning,
             "the encoder reads the same step of {resolution} all the time",
             "the wall's force never changes: the verdict says nothing about it",
             "start further out, or a finer encoder"},
      Phrase{encoder_ripple, "encoder_ripple", warning, ripple, ripple_at_rest, "a finer encoder"},
      Phrase{encoder_ripple_of_damper, "encoder_ripple_of_damper", warning, ripple, ripple_at_rest, quiet_damper},
      Phrase{encoder_ripple_in_drift, "encoder_ripple_in_drift", warning, ripple, ripple_in_drift, "a finer encoder"},
      Phrase{encoder_ripple_of_damper_in_drift, "encoder_ripple_of_damper_in_drift", warning, ripple, ripple_in_drift,
             quiet_damper},
      Phrase{run_ended_early, "run_ended_early", note,
             "the run ended after {simulated}: the position passed {position}", "the later motion is not simulated"},
      Phrase{force_acts_to_the_end, "force_acts_to_the_end", note,
             "the recorded force acts in the part of the run that is judged",
             "the verdict is about the device under that force"},
      Phrase{growth_not_seen, "growth_not_seen", warning,
             "nothing grows within this run, but by linear analysis something does",
             "a slowly growing oscillation may hide under others", "simulate for longer"},
      Phrase{few_oscillations, "few_oscillations", warning, "the run holds too few oscillations to tell", "",
             "simulate for longer"},
      Phrase{stick_slip_not_followed, "stick_slip_not_followed", warning,
             "{steps:n} steps had too many stick-slip instants to follow", "the motion is approximate there"},
      Phrase{motion_linearised, "motion_linearised", note, "the motion is that of the mechanism linearised at its pose",
             "it holds near the pose"},
      Phrase{friction_left_out, "friction_left_out", warning,
             "the motion is that of the mechanism linearised at its pose, without friction: {rubbing:n} of its joints "
             "and cables rub, the strongest by {largest:g} N m (of a slide: N)",
             "friction holds small motions, and lets larger ones die out sooner"},
      Phrase{swing_not_steady, "swing_not_steady", warning,
             "the swing still {does} by {share:%} % over the last half of the record", "not steady: record for longer"},
      Phrase{swing_varies, "swing_varies", warning, "the swing varies by {scatter:%} % and never becomes steady",
             "the oscillation does not repeat itself; frequency and stiffness are averages"},
      Phrase{steady_part_short, "steady_part_short", warning,
             "the steady part has {samples:n} samples, less than a segment of {segment:n}",
             "it is one segment: the frequency is known to {resolution_hz:.3g} Hz only; record for longer"},
      Phrase{position_drifts, "position_drifts", warning,
             "the position drifts by {share:%} % of the amplitude over the steady part",
             "the relay is off centre, or something else pushes"},
      Phrase{few_encoder_steps, "few_encoder_steps", warning, "the oscillation spans few steps of the encoder",
             "a larger force gives a larger motion"},
      Phrase{trials_settle_apart, "trials_settle_apart", refusal,
             "the trials settle at different oscillations, of which there is no mean: {oscillations}", "",
             "compare each with the predictions"},
      Phrase{no_trial_oscillates, "no_trial_oscillates", refusal,
             "no trial oscillates: start further out, push harder or record for longer"},
      Phrase{relay_without_device, "relay_without_device", doubt,
             "what a relay reads is a limit for walls only where friction is small and it oscillates at the limit's "
             "frequency: compare it with a device file"},
      Phrase{relay_without_finite_limit, "relay_without_finite_limit", doubt,
             "linear theory gives this device no finite limit: what the relay reads is the device's response at that "
             "oscillation, no limit for walls"},
      Phrase{relay_reads_more, "relay_reads_more", doubt,
             "the relay reads {decibels:.2f} dB more than the limit of linear theory: build on that limit instead"},
      Phrase{relay_reads_less, "relay_reads_less", doubt,
             "the relay reads {decibels:.2f} dB less than the limit of linear theory, with {samples_per_cycle:.3g} "
             "samples per oscillation: a wall as stiff as the reading is stable, the limit is not the reading"},
      Phrase{relay_without_wall, "relay_without_wall", note,
             "the wall's damper and filters are left out: a relay has no wall",
             "all numbers are of the device without them, not those of an analysis, which closes them"}};
  return phrases;
}

}  // namespace zwidth::internal
