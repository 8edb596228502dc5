#include <array>

#include "words/phrase.hpp"

namespace zwidth::internal {

std::span<const Phrase> io_phrases() {
  using enum FindingCode;
  using enum Finding::Severity;
  static constexpr std::array phrases{
      Phrase{text_table, "text_table", note,
             "text of {columns:n} column{columns:s}{?delimiter| separated by "
             "{?delimiter=,|commas}{?delimiter=;|semicolons}{?delimiter=\t|tabs}{?delimiter= "
             "|blanks}}{?decimal_mark=,|, decimal comma}{?decimal_mark=.|, decimal point}{?header|, header in line "
             "{header:n}}{?names=none|, no header: columns have numbers from 1}{?names=comment|, header in the comment "
             "above the rows}, rows from line {first_row:n}",
             "if this is wrong, state delimiter, decimal mark and header"},
      Phrase{header_with_numbers, "header_with_numbers", warning, "the header in line {line:n} has numbers",
             "if it is a row, state that there is no header"},
      Phrase{last_line_cut_off, "last_line_cut_off", warning,
             "the last line, {line:n}, is cut off{?cells| after {cells:n} of {expected:n} cells} and left out",
             "the {?document|{document} may have been interrupted}{!document|trace may have been saved in part}"},
      Phrase{last_line_without_end, "last_line_without_end", warning,
             "the last line, {line:n}, has no end and {cells:n} of {expected:n} cells: it is left out",
             "the export may have been interrupted"},
      Phrase{empty_lines_in_rows, "empty_lines_in_rows", warning,
             "{lines:n} empty lines between the rows are passed over",
             "if they separate recordings, each must be in its own file"},
      Phrase{rows_outside_common_span, "rows_outside_common_span", note,
             "{column}: {used:n} of {samples:n} samples are used",
             "the others lie outside of what all columns have, {begin:.9g} s to {end:.9g} s"},
      Phrase{samples_missing, "samples_missing", warning,
             "{column}: {missing:n} of {samples:n} samples are missing (NaN, infinite or empty), the first at {place}, "
             "at most {longest:n} in a row; filled by straight lines",
             "what happened there is not in the record: the response is uncertain by about that share"},
      Phrase{column_scaled_by_its_unit, "column_scaled_by_its_unit", note, "{column} is in {unit}",
             "read in base units (N, N m, m, rad, A, V): times {factor:.6g}"},
      Phrase{column_unit_unknown, "column_unit_unknown", warning, "{column} is used as it stands, in {unit}",
             "no unit of a force or motion that is known: results are in it",
             "scale it to SI units; 1 says that it is"},
      Phrase{column_read_in_unit, "column_read_in_unit", note, "column {column} is read in {unit}, as its name says"},
      Phrase{rows_repeated, "rows_repeated", warning,
             "{repeated:n} of {rows:n} rows are repeated ({share:%.2g} %), the first at {place}", "they are left out"},
      Phrase{rows_lost, "rows_lost", warning,
             "{lost:n} of {rows:n} rows are lost ({share:%.2g} %) in {?gaps=1|one gap}{!gaps=1|{gaps:n} gaps}, the "
             "first before {place} ({after:time} after the start), the longest of {longest:n} row{longest:s}",
             "{?filled|{filled:n} are filled in from the rows around them, which tell the first signal to {error:%.2g} "
             "% of its size}{?used|{?filled|; }what happened in {?filled|the other}{!filled|the} gaps is not known: "
             "used is the longest stretch without such a gap alone, {used:time} from {from} on}",
             "log every row"},
      Phrase{jitter_of_rows, "jitter_of_rows", warning,
             "the times are up to {largest:%.2g} % of a period off equal steps (rms {rms:%.2g} %)",
             "the rows were sampled so, as the motion shows: it is interpolated at equal steps, and the force that was "
             "held is averaged over each"},
      Phrase{jitter_of_stamps, "jitter_of_stamps", warning,
             "the times are up to {largest:%.2g} % of a period off equal steps (rms {rms:%.2g} %)",
             "the rows were sampled at equal steps, as the motion shows: the stamps alone are off"},
      Phrase{jitter_undecided, "jitter_undecided", doubt,
             "the times are up to {largest:%.2g} % of a period off equal steps (rms {rms:%.2g} %)",
             "whether the rows or their stamps alone are off does not show in the motion: the delay is known to "
             "{delay:.2g} periods",
             "log the time at which a row is sampled, or state the rate"},
      Phrase{rate_of_times, "rate_of_times", note,
             "rate {rate:.7g} Hz: the mean of the times in column {column}, read in units of {?scale|{scale:.6g} "
             "s}{?scale_of_name|{scale_of_name:.6g} s as its name says}"},
      Phrase{rate_of_file, "rate_of_file", note, "rate {rate:.7g} Hz: what the file states"},
      Phrase{rate_contradicts_times, "rate_contradicts_times", doubt,
             "the rate is given as {given:.7g} Hz; the times in column {column} say {stated:.7g} Hz",
             "the given rate is used; leave it out to use the times, or give their scale"},
      Phrase{rate_contradicts_file, "rate_contradicts_file", doubt,
             "the rate is given as {given:.7g} Hz; the file states {stated:.7g} Hz", "the given rate is used"},
      Phrase{period_unusual, "period_unusual", warning, "a sampling period of {period:time} is unusual",
             "if the times are not in the unit above, state the unit (`time_scale`; milliseconds: 1e-3)"},
      Phrase{stated_offset_unused, "stated_offset_unused", warning,
             "the header states a scale factor of {factor:.6g} and an offset of {offset:.6g} for {column}",
             "used as it stands: an offset alone changes no response"},
      Phrase{stated_scale_unused, "stated_scale_unused", warning,
             "the header states a scale factor of {factor:.6g} and an offset of {offset:.6g} for {column}",
             "the scale that is given counts alone"},
      Phrase{stated_scale_unclear, "stated_scale_unclear", doubt,
             "the header states a scale factor of {factor:.6g} and an offset of {offset:.6g} for {column}",
             "the file does not say whether its values are scaled by it: they are used as they stand",
             "give the column's scale: 1 where they are scaled, {factor:.6g} where they are raw"},
      Phrase{more_rows_than_stated, "more_rows_than_stated", doubt,
             "the header states {stated:n} samples of {column} and {rows:n} rows follow, without times",
             "{?rate|the rate that is given counts}{!rate|they are read as if no time were lost between one write and "
             "the next; state the rate where that is so}"},
      Phrase{channel_sampled_off_the_first, "channel_sampled_off_the_first", warning,
             "{column} was sampled {microseconds:.3g} us {side} the first channel by its header",
             "its rows are taken for samples of the same instants: the response has that much more or less delay"},
      Phrase{twincat_scope_export, "twincat_scope_export", note,
             "an export of TwinCAT Scope: {channels:n} channels, {time_columns:n} time columns in ms{?decimal_mark=,|, "
             "decimal comma}{?decimal_mark=.|, decimal point}, rows from line {first_row:n}"},
      Phrase{slow_rows_repeated, "slow_rows_repeated", note,
             "{rows:n} rows of a group have the time and the values of the one above and count once",
             "an export fills the gaps of slow channels so"},
      Phrase{codesys_trace, "codesys_trace", note,
             "a trace of CODESYS: {variables:n} variables, each with times of its own{?unit| in {unit}}"},
      Phrase{controldesk_export, "controldesk_export", note,
             "an export of dSPACE ControlDesk: {signals:n} signals in {sections:n} section{sections:s}, times in s"},
      Phrase{labview_measurement_file, "labview_measurement_file", note,
             "a LabVIEW measurement file: {channels:n} channels, {?times=stated|times from X0 and "
             "Delta_X}{?times=each|a time column for each}{?times=one|one time column}, {segments:n} "
             "segment{segments:s}, rows from line {first_row:n}"},
      Phrase{objects_skipped, "objects_skipped", note, "MATLAB objects are skipped: {arrays}",
             "what they hold can be read once it is saved as numeric arrays"},
      Phrase{not_numeric_skipped, "not_numeric_skipped", note, "no numeric arrays, skipped: {arrays}"},
      Phrase{complex_skipped, "complex_skipped", note, "complex arrays are skipped: {arrays}", "a signal is real"},
      Phrase{no_signals_skipped, "no_signals_skipped", note, "no signals, skipped: {arrays}"},
      Phrase{damaged_skipped, "damaged_skipped", warning, "damaged, skipped: {arrays}",
             "the file may be broken: save or copy it again"},
      Phrase{single_numbers, "single_numbers", note, "single numbers: {numbers}"},
      Phrase{datasets_passed_over, "datasets_passed_over", note,
             "datasets that are no functions are passed over: {datasets}"},
      Phrase{dataset_not_closed, "dataset_not_closed", warning, "the dataset at line {line:n} has no closing line -1",
             "the file may be cut off"},
      Phrase{function_cut_off, "function_cut_off", warning,
             "the function at line {line:n} has {points:n} of the {stated:n} points that its header says",
             "the file was cut off; what is there is used"},
      Phrase{response_of_velocity, "response_of_velocity", note,
             "the record is a velocity per force: divided by jw to get a position"},
      Phrase{response_of_acceleration, "response_of_acceleration", note,
             "the record is an acceleration per force: divided by -w^2 to get a position"},
      Phrase{response_of_unknown_quantity, "response_of_unknown_quantity", warning,
             "the record does not say what it measures (quantity {quantity:n}, {?unit|the unit {unit}}{!unit|no "
             "unit}); it is taken as a position per force",
             "if it is an acceleration or a velocity, stiffnesses from it are meaningless"},
      Phrase{repeated_lines_averaged, "repeated_lines_averaged", note,
             "{lines:n} lines at {frequencies:n} frequencies are averaged, with the noise that their scatter "
             "shows{!once=0|; {once:n} that come once are taken for as noisy}"},
      Phrase{lines_without_number, "lines_without_number", warning,
             "{missing:n} of {lines:n} lines have NaN, an infinity or no number and are left out{!line=0|, the first "
             "at line {line:n}}",
             "nothing is known there: a crossing may be missed"},
      Phrase{zero_frequency_left_out, "zero_frequency_left_out", note,
             "the value at 0 Hz is left out{!line=0|, the first at line {line:n}}"}};
  return phrases;
}

}  // namespace zwidth::internal
