#include <array>

#include "words/problem_phrase.hpp"

namespace zwidth::internal {

std::span<const ProblemPhrase> identification_problem_phrases() {
  using enum ProblemCode;
  static constexpr const char* allowed_limit =
      "{?decimal|a point as the decimal mark: \"K=3.5\"}{?meant|did you mean {meant}?}{!decimal|{!meant|K=STIFFNESS, "
      "B=DAMPING, hz=FREQUENCY, of which K must be there: \"K=3, B=0, hz=40\"}}";
  static constexpr std::array phrases{
      ProblemPhrase{no_rising_band, "no_rising_band", "band from {lowest:.6g} to {highest:.6g} rad/s",
                    "rising, from 0 on"},
      ProblemPhrase{no_share_below_one, "no_share_below_one", "is {value:exact}", "must be from 0 to below 1"},
      ProblemPhrase{segments_of_periodic_force, "segments_of_periodic_force", "is given for a periodic force",
                    "must be left out, or the force taken as aperiodic"},
      ProblemPhrase{periods_of_aperiodic_force, "periods_of_aperiodic_force", "is {value:n} for an aperiodic force",
                    "must be 0, or the force periodic"},
      ProblemPhrase{lines_beside_segments, "lines_beside_segments", "are given beside a segment's length or a period",
                    "must be left out, or they: lines are fitted in the whole record"},
      ProblemPhrase{segment_not_in_record, "segment_not_in_record", "segments of {value:n} samples",
                    "{least:n} to {most:n}, the record's length{?shortened| less what differences take}"},
      ProblemPhrase{period_not_in_record, "period_not_in_record",
                    "period of {value:n} samples in a record of {samples:n}", "2 up to half the record"},
      ProblemPhrase{periods_all_skipped, "periods_all_skipped", "{value:n} of {periods:n} whole periods skipped",
                    "at least two must remain"},
      ProblemPhrase{line_beyond_nyquist, "line_beyond_nyquist", "line at {hertz:.6g} Hz",
                    "below half the sampling rate, {nyquist:.6g} Hz"},
      ProblemPhrase{line_twice, "line_twice", "line at {hertz:.6g} Hz comes twice", "each once"},
      ProblemPhrase{lines_too_close_for_record, "lines_too_close_for_record",
                    "the record of {duration:.4g} s is too short to tell the lines apart",
                    "at least {least:.4g} s, or fewer lines"},
      ProblemPhrase{band_leaves_no_line, "band_leaves_no_line", "no line is left in the band asked for", "widen it"},
      ProblemPhrase{period_without_line, "period_without_line",
                    "the force excites no line of a period of {value:n} samples",
                    "leave the period out, or give the force's own{?repeats|: it repeats every {repeats:n} "
                    "samples}"},
      ProblemPhrase{no_line_excited, "no_line_excited",
                    "the force excites no line that {samples:n} samples ({duration:.3g} s) tell apart: the "
                    "record is too short, or the force hardly changes",
                    "record for longer, several periods of the lowest frequency at least"},
      ProblemPhrase{sample_not_a_number, "sample_not_a_number", "sample {sample:n} of the {signal} is {value:exact}",
                    "a number"},
      ProblemPhrase{force_and_motion_of_two_lengths, "force_and_motion_of_two_lengths",
                    "{force:n} samples of force, {motion:n} of the motion", "equally many"},
      ProblemPhrase{record_of_few_samples, "record_of_few_samples", "the record has {samples:n} samples",
                    "at least {least:n}"},
      ProblemPhrase{signal_is_constant, "signal_is_constant",
                    "the {signal} is constant: {?signal=force|it excites nothing}{?signal=motion|nothing to "
                    "measure}",
                    "{?signal=force|a force that varies}{?signal=motion|another column, or a stronger force}"},
      ProblemPhrase{force_does_not_repeat, "force_does_not_repeat",
                    "the force does not repeat itself, within half the record",
                    "give the period, or take it as aperiodic"},
      ProblemPhrase{recording_twice, "recording_twice", "{source}: holds the same samples as {other}",
                    "give each recording once"},
      ProblemPhrase{response_is_continuous, "response_is_continuous", "the critical stiffness of a continuous response",
                    "one of the sampled plant (give its sampling period)"},
      ProblemPhrase{response_of_few_lines, "response_of_few_lines", "the critical stiffness from {lines:n} lines",
                    "at least {least:n}"},
      ProblemPhrase{no_unit_text, "no_unit_text", "is no unit", "at most {most:n} characters, on one line"},
      ProblemPhrase{unit_of_other_column, "unit_of_other_column",
                    "is {given}, but the column is read in {stated} by its name",
                    "leave it out, or give the scale too"},
      ProblemPhrase{no_period_of_table, "no_period_of_table", "missing",
                    "the table has none, and the loop to judge needs one, in seconds"},
      ProblemPhrase{motion_not_fitted, "motion_not_fitted",
                    "fits the motion{?bodies| of {bodies:n} bodies}{?samples| of {samples:n} samples}",
                    "must fit the lines {?bodies|of more than {most:n}}{?samples|of fewer than "
                    "{least:n}}{!bodies|{!samples|where no position is recorded}}"},
      ProblemPhrase{limit_part_without_value, "limit_part_without_value", "{part} has no =", allowed_limit},
      ProblemPhrase{no_number_of_limit, "no_number_of_limit", "{word} is no number of a limit", allowed_limit},
      ProblemPhrase{limit_without_stiffness, "limit_without_stiffness", "has no K", allowed_limit}};
  return phrases;
}

}  // namespace zwidth::internal
