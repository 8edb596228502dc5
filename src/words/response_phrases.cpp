#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> response_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  static constexpr std::array phrases{
      Phrase{excitation_rounded, "excitation_rounded", note,
             "{?what=duration|the duration}{?what=frequency|the relay's frequency} is {actual:.9g} {unit} instead of "
             "{wanted:.9g}",
             "rounded to whole samples"},
      Phrase{excitation_shorter_than_cycle, "excitation_shorter_than_cycle", warning,
             "{duration:g} s hold less than one cycle of {frequency:g} Hz",
             "nothing can be told about that frequency; make the duration longer"},
      Phrase{excitation_beyond_force_limit, "excitation_beyond_force_limit", warning,
             "the peak force, {force:.4g} {unit}, is beyond the actuator's limit, {limit:.4g} {unit}",
             "the actuator would saturate; lower the amplitude"},
      Phrase{excitation_beyond_stroke, "excitation_beyond_stroke", warning,
             "the device moves {stroke:.4g} {unit} from its start, beyond the stroke of {limit:.4g} {unit}",
             "lower the amplitude, raise the lowest frequency, or lock a body"},
      Phrase{excitation_moves_few_steps, "excitation_moves_few_steps", warning,
             "the device moves at most {stroke:.4g} {unit}, {steps:.2g} steps of its encoder",
             "the record would be mostly rounding; raise the amplitude"},
      Phrase{excitation_of_doubtful_device, "excitation_of_doubtful_device", warning,
             "the device's file is not to be relied on: {reason}", "the stroke may be another; begin with less force"},
      Phrase{stroke_without_friction, "stroke_without_friction", note,
             "the stroke is computed without Coulomb friction", "the device moves less than that, or not at all"},
      Phrase{channel_in_counts, "channel_in_counts", doubt,
             "{channel} holds {?counts=whole|whole numbers}{?counts=half|numbers that are whole ones apart} only, as "
             "{?role=force|a converter gives}{?role=motion|an encoder counts}",
             "every number is then per count",
             "give the {?role=force|newtons (or newton metres)}{?role=motion|metres or radians} per count"},
      Phrase{force_of_two_values, "force_of_two_values", note,
             "{channel} takes two values only: an amplifier that gives less shows in nothing",
             "every number would come out as if it gave all, and the critical stiffness too high by as much",
             "stay well below the amplifier's limit, or record noise, a sweep or a multisine"},
      Phrase{channels_of_two_motions, "channels_of_two_motions", doubt,
             "{force} is in {force_unit} and {channel} in {unit} by their names, of a {of_force} motion and of a "
             "{of_motion}: give the scale that makes them of one, by the radius"},
      Phrase{channel_of_other_quantity, "channel_of_other_quantity", doubt,
             "{channel} is in {unit} by its name, and is taken for {?role=force|a force or torque}{?role=motion|the "
             "motion}: name the right column, or give its scale"},
      Phrase{channel_unit_unknown, "channel_unit_unknown", doubt,
             "{channel} is in {unit} by its name, which is no unit of {?role=force|a force or torque}{?role=motion|the "
             "motion} that is known: every number is then in that unit",
             "give its scale, {?role=force|newtons or newton metres}{?role=motion|metres or radians} per unit of it (1 "
             "says that it is in SI units)"},
      Phrase{channel_of_other_motion, "channel_of_other_motion", doubt,
             "{channel} is in {unit} by its name, of a {of_channel} motion, and the structure's is {of_structure}: "
             "every number has the wrong unit",
             "set the structure's motion, or give the scale from one to the other"},
      Phrase{force_beyond_limit, "force_beyond_limit", doubt,
             "{channel} reaches {force} where the structure's actuator.force_limit is {limit}: less acted than the "
             "record says",
             "record with less, or correct the limit"},
      Phrase{rows_thinned, "rows_thinned", doubt,
             "a row stands for {periods:.0f} periods of the loop, {row_period} and {loop_period}: where rows were left "
             "out of the log, so is the force between them, and the fit lacks delay",
             "log every period, or, where the force was held from row to row, identify with the rows' period and set "
             "loop.sampling_period in the device file"},
      Phrase{clipped_for_response, "clipped_for_response", doubt,
             "{channel} is clipped: the response is not that of a linear device; reduce the amplitude"},
      Phrase{clipped_for_equations, "clipped_for_equations", doubt,
             "{channel} is clipped: force and motion do not belong together there; reduce the amplitude"},
      Phrase{segments_averaged, "segments_averaged", note,
             "{segments:n} segments of {samples:n} samples ({spacing:.4g} Hz between lines), worth {averages:.1f} "
             "independent averages{?form|; force and motion differenced, against drift}"},
      Phrase{lines_of_whole_record, "lines_of_whole_record", note,
             "lines {spacing:.4g} Hz apart, each by a parabola through those of the whole record within as much: its "
             "segments left the critical stiffness open"},
      Phrase{begins_at_rest, "begins_at_rest", note,
             "the record begins at rest, and is taken to have been at rest before"},
      Phrase{lines_of_record_ends, "lines_of_record_ends", note,
             "{lines:n} lines are left out: the force excites them only where the record begins or ends",
             "a device fitted to a record that begins at rest has them all the same; else let the force begin later, "
             "or end earlier, than the record"},
      Phrase{too_few_averages, "too_few_averages", warning,
             "fewer than two independent averages: the noise cannot be told from the response",
             "give shorter segments, or record for longer"},
      Phrase{segments_too_short, "segments_too_short", warning,
             "the segments are too short to resolve the response near {frequency:.4g} Hz: the window smears it by "
             "{smearing:%.0f} %",
             "peaks there are in truth sharper; record for longer, or give longer segments"},
      Phrase{periods_averaged, "periods_averaged", note,
             "period of {samples:n} samples ({period:.4g} s); {averaged:n} of {periods:n} whole periods "
             "averaged{?skipped|, the first {skipped:n} skipped as transient}{?of_drift|, one spent on taking off the "
             "drift}"},
      Phrase{transient_in_periods, "transient_in_periods", warning,
             "the first {periods:n} of the averaged periods differ from the later ones: the transient has not died out",
             "skip more periods"},
      Phrase{force_repeats, "force_repeats", note, "the force repeats every {samples:n} samples"},
      Phrase{sine_fitted_in_one_piece, "sine_fitted_in_one_piece", note,
             "a sine of {frequency:.6g} Hz fitted to {periods:.3g} periods in one piece",
             "its noise is what the motion has at the frequencies beside it; record for longer"},
      Phrase{lines_fitted_in_blocks, "lines_fitted_in_blocks", note,
             "{?lines=1|a sine of {frequency:.6g} Hz}{!lines=1|{lines:n} lines} fitted in {blocks:n} blocks of "
             "{duration:.4g} s{?skipped|, {skipped:n} before them left out as transient}"},
      Phrase{velocity_integrated, "velocity_integrated", note, "the velocity is turned into a position by 1/(jw)",
             "an approximation under a held force: the position comes out too large by about (wT)^2/12 for a velocity, "
             "twice that for an acceleration, and the critical stiffness too low; a filter that made the signal is "
             "part of the response"},
      Phrase{acceleration_integrated, "acceleration_integrated", note,
             "the acceleration is turned into a position by -1/w^2",
             "an approximation under a held force: the position comes out too large by about (wT)^2/12 for a velocity, "
             "twice that for an acceleration, and the critical stiffness too low; a filter that made the signal is "
             "part of the response"},
      Phrase{response_without_rate, "response_without_rate", refusal, "a response without a sampling rate",
             "hold and delay are not in it, so that it has no critical stiffness; give the rate of a sampled one, or "
             "fit a device to it"},
      Phrase{response_of_one_line, "response_of_one_line", refusal, "a response of a single line",
             "crossovers lie between lines: excite a band"},
      Phrase{response_without_noise, "response_without_noise", refusal, "the response comes without its noise",
             "intervals show only how far lines stand off their neighbours"},
      Phrase{
          phase_measured, "phase_measured", note,
          "the phase is measured {?at|at {at:.4g} Hz}{!at|from {from:.4g} to {to:.4g} Hz}; outside, nothing is known",
          "a softer crossover there would limit instead"},
      Phrase{phase_half_turn_off, "phase_half_turn_off", refusal,
             "the position falls as the force rises: where the band begins the response falls as a mass's does, and "
             "its phase, {phase:.0f} degrees, is half a turn off",
             "scale one of them by -1"},
      Phrase{phase_left_open, "phase_left_open", refusal,
             "the noise leaves the phase open by more than 30 degrees {?at|at {at:.4g} Hz}{!at|from {from:.4g} to "
             "{to:.4g} Hz}",
             "the response alone leaves the critical stiffness open; excite more strongly or for longer"},
      Phrase{phase_not_told, "phase_not_told", refusal,
             "the phase cannot be told from -180 degrees anywhere in the band",
             "the response alone leaves the critical stiffness open; excite more strongly or for longer"},
      Phrase{phase_past_at_beginning, "phase_past_at_beginning", refusal,
             "the phase is past -180 degrees already where the band begins, {frequency:.4g} Hz",
             "the crossover that limits lies below, or no wall is stable (is the sign of the motion right?); excite "
             "lower frequencies"},
      Phrase{no_crossover_in_band, "no_crossover_in_band", refusal,
             "the phase does not pass -180 degrees {?at|at {at:.4g} Hz}{!at|from {from:.4g} to {to:.4g} Hz}",
             "the crossover that limits, if there is one, lies outside; excite a wider band"},
      Phrase{noise_may_hide_softer_crossover, "noise_may_hide_softer_crossover", refusal,
             "the noise hides whether the phase passes -180 degrees {where}{?more|, and in {more:n} more bands up to "
             "{up_to:.4g} Hz}",
             "a crossover there would be softer than any that is proven: the response alone leaves the critical "
             "stiffness unknown"},
      Phrase{noise_hides_crossover, "noise_hides_crossover", refusal,
             "the noise hides whether the phase passes -180 degrees {where}{?more|, and in {more:n} more bands up to "
             "{up_to:.4g} Hz}",
             "the response alone leaves the critical stiffness unknown"},
      Phrase{
          lines_too_far_apart, "lines_too_far_apart", refusal,
          "the phase falls far between the neighbouring lines {?at|at {at:.4g} Hz}{!at|from {from:.4g} to {to:.4g} Hz}",
          "a resonance peaks there unseen: the stiffness of its crossover is a guess between the lines; longer periods "
          "or segments give closer lines"},
      Phrase{springlike_at_beginning, "springlike_at_beginning", refusal,
             "the device looks like a spring where the band begins, {frequency:.4g} Hz",
             "right for one that is locked or tied to ground; a free one has a softer crossover below the band: excite "
             "lower frequencies"},
      Phrase{not_rigid_at_beginning, "not_rigid_at_beginning", refusal,
             "the response is not that of a rigid body where the band begins, {frequency:.4g} Hz",
             "there may be a softer crossover below the band: excite lower frequencies"},
      Phrase{gap_between_lines, "gap_between_lines", refusal,
             "no line is excited {?at|at {at:.4g} Hz}{!at|from {from:.4g} to {to:.4g} Hz}",
             "a crossover there is not seen"},
      Phrase{no_limit_proven, "no_limit_proven", refusal,
             "the data prove no critical stiffness; excite a wider band, more strongly"},
      Phrase{recordings_differ, "recordings_differ", doubt,
             "recordings of about the same force differ by {difference:percent} (median of {lines:n} lines that show "
             "it above the noise)",
             "the device, its load or its place has changed between them", "look at the recordings one by one"},
      Phrase{response_depends_on_force, "response_depends_on_force", doubt,
             "the response depends on the force: {times:.2g} times the force changes it by {difference:percent} "
             "(median of {lines:n} lines that show it above the noise)",
             "not as dry friction does: a spring that hardens, or a limit of force or current",
             "look at the recordings one by one"},
      Phrase{response_depends_as_by_friction, "response_depends_as_by_friction", doubt,
             "the response depends on the force: {times:.2g} times the force changes it by {difference:percent} "
             "(median of {lines:n} lines that show it above the noise)",
             "so dry friction{?force| of about {force}} does: it holds a weak force more, and looks like damping",
             "identify the device, which fits friction"},
      Phrase{recordings_disagree_on_limit, "recordings_disagree_on_limit", doubt,
             "the recordings disagree on the critical stiffness: {stiffnesses}, outside the interval of all"},
      Phrase{motion_shows_friction, "motion_shows_friction", doubt,
             "the motion shows dry friction, which the response takes for damping: about {force} at least",
             "larger motions have less of it, and a lower critical stiffness",
             "repeat it with several times the force and give both recordings, or identify the device, which fits "
             "friction"},
      Phrase{motion_shows_drag, "motion_shows_drag", doubt,
             "the motion shows drag that grows with the square of the speed, which the response takes for damping",
             "smaller motions have less of it, and a lower critical stiffness",
             "repeat it with a third of the force and give both recordings, or identify the device, which fits drag"},
      Phrase{friction_would_pass_unseen, "friction_would_pass_unseen", doubt,
             "dry friction of {force} would pass unseen, and the critical stiffness without it {?stiffness|would be "
             "{stiffness}}{!stiffness|is not known}",
             "",
             "repeat it with several times the force and give both recordings, or identify the device, which fits "
             "friction"},
      Phrase{friction_unknown, "friction_unknown", note,
             "the recordings do not show dry friction: how much of the damping is dry friction, and the critical "
             "stiffness too high, is not known",
             "",
             "repeat it with several times the force and give both recordings, or identify the device, which fits "
             "friction"},
      Phrase{one_amplitude, "one_amplitude", note,
             "forces of one amplitude: dry friction and whatever else is not linear pass for damping, and make the "
             "critical stiffness too high",
             "",
             "give a recording with several times the force beside it, or identify the device, which fits friction"},
      Phrase{table_hides_friction, "table_hides_friction", note,
             "a table does not show dry friction, which makes a small motion look more damped and the critical "
             "stiffness too high",
             "", "give the recordings themselves"},
      Phrase{table_gives_no_reason, "table_gives_no_reason", refusal,
             "the table says so of its critical stiffness, and not why: see the recording"}};
  return phrases;
}

}  // namespace zwidth::internal
