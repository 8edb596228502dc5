#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> relay_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  static constexpr std::array phrases{
      Phrase{record_too_short, "record_too_short", note, "the record has {samples:n} samples; at least {threshold:n}"},
      Phrase{force_never_changes, "force_never_changes", note, "the force never changes"},
      Phrase{position_never_changes, "position_never_changes", note, "the position never changes"},
      Phrase{force_stops_changing, "force_stops_changing", note, "the force no longer changes after {since:.4g} s"},
      Phrase{position_stops_changing, "position_stops_changing", note,
             "the position no longer changes after {since:.4g} s"},
      Phrase{too_few_cycles, "too_few_cycles", note, "the record holds no oscillation of at least {threshold:n} cycles",
             "", "record for longer"},
      Phrase{too_few_cycles_in_segment, "too_few_cycles_in_segment", note,
             "a segment of {segment:n} samples holds {cycles:.2g} cycles of the oscillation near {frequency_hz:.3g} "
             "Hz; at least {threshold:n}: make the segments longer"},
      Phrase{no_frequency_stands_out, "no_frequency_stands_out", note,
             "no frequency stands out: the strongest holds {share:%} % of the motion's power; at least {threshold:%} "
             "%"},
      Phrase{trials_at_different_oscillations, "trials_at_different_oscillations", note,
             "The trials settle at different oscillations, {oscillations}: several exist side by side, and the start "
             "decides. Compare each with the predictions above."},
      Phrase{no_linear_crossover, "no_linear_crossover", note,
             "Linear theory knows no phase crossover of this device."},
      Phrase{reads_more_at_crossover, "reads_more_at_crossover", note,
             "It oscillates near the phase crossover of linear theory at {frequency_hz} Hz, {stiffness_db:.2f} dB "
             "({?mode|vibration mode {mode:n}}{!mode|the rigid body}): the relay reads {difference_db:.2f} dB more."},
      Phrase{reads_less_at_crossover, "reads_less_at_crossover", note,
             "It oscillates near the phase crossover of linear theory at {frequency_hz} Hz, {stiffness_db:.2f} dB "
             "({?mode|vibration mode {mode:n}}{!mode|the rigid body}): the relay reads {difference_db:.2f} dB less."},
      Phrase{oscillates_off_crossovers, "oscillates_off_crossovers", note,
             "It oscillates at no phase crossover of linear theory, the nearest being at {frequency_hz} Hz, "
             "{stiffness_db:.2f} dB ({?mode|vibration mode {mode:n}}{!mode|the rigid body}): what the relay reads is "
             "the device's response there, not a limit of stability."},
      Phrase{reading_confirms_limit, "reading_confirms_limit", note,
             "The stiffest stable wall by linear theory is at {frequency_hz} Hz, {stiffness_db:.2f} dB. The relay "
             "confirms it."},
      Phrase{reading_coincides_with_limit, "reading_coincides_with_limit", note,
             "The stiffest stable wall by linear theory is at {frequency_hz} Hz, {stiffness_db:.2f} dB. The relay "
             "reads the same stiffness, but at another frequency: a coincidence."},
      Phrase{reading_above_limit, "reading_above_limit", note,
             "The stiffest stable wall by linear theory is at {frequency_hz} Hz, {stiffness_db:.2f} dB. The relay "
             "reads {difference_db:.2f} dB more: taken for that limit it is UNSAFE."},
      Phrase{reading_below_limit, "reading_below_limit", note,
             "The stiffest stable wall by linear theory is at {frequency_hz} Hz, {stiffness_db:.2f} dB. The relay "
             "reads {difference_db:.2f} dB less: taken for that limit it is too cautious."},
      Phrase{no_linear_limit, "no_linear_limit", note,
             "Linear theory gives this device no finite limit to compare with."},
      Phrase{friction_leaves_no_cycle, "friction_leaves_no_cycle", note,
             "Coulomb friction of up to {level:%.1f} % of the relay's force acts as a damping that grows as the motion "
             "slows. By first harmonics alone no oscillation would be left near this one: the harmonics of the square "
             "wave, near a resonance, keep it up."},
      Phrase{friction_moves_cycle, "friction_moves_cycle", note,
             "Coulomb friction of up to {level:%.1f} % of the relay's force acts as a damping that grows as the motion "
             "slows. By first harmonics it moves the oscillation away from the crossover, to {frequency_hz} Hz, "
             "{stiffness_db:.2f} dB.{?harmonics| The rest of the way is that of the higher harmonics.}"},
      Phrase{friction_leaves_cycle, "friction_leaves_cycle", note,
             "Coulomb friction of up to {level:%.1f} % of the relay's force acts as a damping that grows as the motion "
             "slows. By first harmonics it leaves the oscillation at {frequency_hz} Hz, {stiffness_db:.2f} "
             "dB.{?harmonics| The rest of the way is that of the higher harmonics.}"},
      Phrase{sampled_relay_without_oscillation, "sampled_relay_without_oscillation", note,
             "Without friction and encoder the sampled relay has no simple oscillation (one switch each way per "
             "period) above {lowest_hz} Hz; below it was not searched."},
      Phrase{sampled_relay_has_this_one, "sampled_relay_has_this_one", note,
             "Without friction and encoder the sampled relay has {cycles:n} exact oscillation{cycles:s} ({bands} Hz), "
             "this one among them; the start decides between them."},
      Phrase{sampled_relay_apart_by_friction, "sampled_relay_apart_by_friction", note,
             "Without friction and encoder the sampled relay has {cycles:n} exact oscillation{cycles:s} ({bands} Hz), "
             "none of them this one: friction makes the difference; the start decides between them."},
      Phrase{sampled_relay_apart_by_switches, "sampled_relay_apart_by_switches", note,
             "Without friction and encoder the sampled relay has {cycles:n} exact oscillation{cycles:s} ({bands} Hz), "
             "none of them this one: it switches more often than once each way per period, or the encoder matters; the "
             "start decides between them."}};
  return phrases;
}

}  // namespace zwidth::internal
