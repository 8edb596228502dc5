#include <array>

#include "words/problem_phrase.hpp"

namespace zwidth::internal {

std::span<const ProblemPhrase> recording_problem_phrases() {
  using enum ProblemCode;
  static constexpr std::array phrases{
      // What a file is
      ProblemPhrase{no_text_table, "no_text_table",
                    "is {?kind=trace_in_utf16|XML in UTF-16, as the trace of a controller is}{?kind=xml|XML}"
                    "{?kind=utf16|text in UTF-16}{?kind=sheet|a ZIP archive or a spreadsheet}"
                    "{?kind=old_sheet|an old spreadsheet or document}{?kind=gzip|compressed with gzip}"
                    "{?kind=tdms|a TDMS file}{?kind=binary|binary data}{?kind=mat|a MAT file}"
                    "{?kind=carriage_returns|text whose lines end with a carriage return alone}",
                    "must be a text table"
                    "{?kind=trace_in_utf16|: save the trace as CSV, in CODESYS as *.trace.csv}"
                    "{?kind=xml|: save the trace as CSV, in CODESYS as *.trace.csv}"
                    "{?kind=utf16| in UTF-8 or ASCII: convert it with iconv -f UTF-16 -t UTF-8}"
                    "{?kind=sheet|: save the sheet as CSV}{?kind=old_sheet|: save the sheet as CSV}"
                    "{?kind=gzip|: unpack it with gunzip}{?kind=tdms|, a MAT file or a UFF file: export it as CSV}"
                    "{?kind=binary|, a MAT file (v5 or v7.3) or a UFF file (dataset 58)}"
                    "{?kind=mat| or a record of a universal file, where it is a response}"
                    "{?kind=carriage_returns| with a line feed at the end of each line}"},
      ProblemPhrase{no_rows_of_numbers, "no_rows_of_numbers",
                    "{?beginning|{?lines=1|has one line, {beginning}, and no row of numbers}"
                    "{!lines=1|has no rows of numbers; it begins with {beginning}}}"
                    "{!beginning|{?lines=0|is empty}{!lines=0|has comments or empty lines only}}",
                    "must be a table: columns of numbers separated by commas, semicolons, tabs or blanks, below a "
                    "header that may be passed over (`skip_rows`)"},
      ProblemPhrase{format_needs_a_file, "format_needs_a_file",
                    "has the format {format}, which cannot be read from a pipe",
                    "must be text, or a file given by its name"},
      ProblemPhrase{does_not_fit_in_memory, "does_not_fit_in_memory", "does not fit into memory",
                    "must be shorter, or have fewer columns asked for"},
      ProblemPhrase{too_many_rows_skipped, "too_many_rows_skipped", "are {rows:n}, and the file has {lines:n} lines",
                    "must be fewer (`skip_rows`)"},
      ProblemPhrase{separator_not_possible, "separator_not_possible",
                    "{?of=twincat|is an export of TwinCAT Scope separated by {separator}}"
                    "{!of=twincat|{?separator|states the decimal separator {separator}}"
                    "{!separator|is none of the known ones}}",
                    "must be {?of=delimiter|, or ; or a tab or a blank}{?of=decimal_mark|a point or a comma}"
                    "{?of=labview|a tab, a comma or a semicolon}"
                    "{?of=twincat|separated by tabs or semicolons: names and times of day have blanks and colons in "
                    "them}"},
      ProblemPhrase{decimal_mark_is_delimiter, "decimal_mark_is_delimiter", "is the delimiter", "they must differ"},

      // Columns
      ProblemPhrase{no_columns, "no_columns",
                    "{?format=codesys|is a trace of CODESYS without variables}"
                    "{?format=twincat|is an export of TwinCAT Scope without channels}"
                    "{!format|{?asked|no columns are asked for}{!asked|has no columns}}",
                    "{?asked|name one at least}{!asked|must have one at least"
                    "{?format=codesys| (\"0.Variable; NAME\")}"
                    "{?format=twincat|, in a line each group of which begins with \"Name\"}}"},
      ProblemPhrase{no_such_column, "no_such_column", "no such column",
                    "{?meant|did you mean \"{meant}\"? }the file has {columns:n} column{columns:s}: {names}"},
      ProblemPhrase{column_name_not_unique, "column_name_not_unique",
                    "{?records|{records:n} records}{!records|{columns:n} columns} have this name",
                    "must be one of their numbers: {numbers}"},
      ProblemPhrase{too_few_samples, "too_few_samples",
                    "has {samples:n} {?lines|usable of {lines:n} lines of a response}{!lines|sample{samples:s}}",
                    "must have two at least"},

      // Lines and cells
      ProblemPhrase{wrong_number_of_cells, "wrong_number_of_cells",
                    "{?as=rows|the header has {cells:n} cells and the rows have {expected:n}}"
                    "{!as=rows|has {cells:n} cell{cells:s}}",
                    "{?as=rows|must have a name for each column; where it is no header, pass it over (`skip_rows` "
                    "{line:n})}"
                    "{!as=rows|must have {expected:n} cell{expected:s} as {?as=header|the header has}"
                    "{?as=most_lines|most of the first lines have}{?as=section|the section's first row has}"
                    "{?as=names|the line of names has}"
                    "{?as=channels|the line of channels has{?groups|, or end after a group of channels}: export with "
                    "time columns, and no comma both as separator and as decimal mark}"
                    "{?as=sample|a sample has: \"; time; value\"}"
                    "{?rows|; lines of a header can be passed over (`skip_rows`)}}"},
      ProblemPhrase{line_without_header, "line_without_header",
                    "is a line without {?format=codesys|a variable}{?format=controldesk|a section}"
                    "{?format=labview|the header of a segment}{?format=twincat|a line of channels} above it",
                    "must follow {?format=codesys|its variable (\"0.Variable; NAME\") and \"0.Data;\"}"
                    "{?format=controldesk|the line that begins with \"trace_values\"}"
                    "{?format=labview|\"***End_of_Header***\" and a line of names; or pass the header over "
                    "(`skip_rows`)}"
                    "{?format=twincat|a line of channels that begins with \"Name\"; or pass the header over "
                    "(`skip_rows`)}"},
      ProblemPhrase{line_among_rows, "line_among_rows", "begins with {beginning} among the rows",
                    "must {?format=controldesk|begin with an empty cell, or follow an empty line}"
                    "{?format=twincat|be a row of numbers, or \"EOF\" at the end: export without tables of markers}"},
      ProblemPhrase{section_incomplete, "section_incomplete",
                    "{?names|names {names:n} column{names:s}}"
                    "{!names|has {?values=0|no values}{!values=0|values of signals without names}}",
                    "{?names|must name X_Value and a channel{?in_turn|, in turn}{!in_turn| at least}}"
                    "{!names|must follow a line \"trace_names\" or \"path\", with a time and a value for each signal}"},
      ProblemPhrase{ends_in_header, "ends_in_header", "ends in the header of a LabVIEW measurement file",
                    "must go on with a line of names and rows"},
      ProblemPhrase{segment_of_other_columns, "segment_of_other_columns",
                    "begins segment {segment:n} with other columns",
                    "segments of one file must have the same columns, or be files of their own"},
      ProblemPhrase{
          no_number_in_cell, "no_number_in_cell",
          "{cell} {?why=hexadecimal|is hexadecimal}{?why=time_of_day|is a time of day}"
          "{?why=thousands|groups its thousands}{?why=fortran|has the exponent of Fortran}"
          "{?why=range|is too large}"
          "{?why=decimal_mark|is no number: the decimal mark is {?decimal_mark=.|a point}{?decimal_mark=,|a comma}}"
          "{!why|is no {?as=complex|complex }number}",
          "{?as=header|must be a number; where the line is part of a header, pass over all of it (`skip_rows` "
          "{line:n})}"
          "{?as=time|times must be numbers, such as seconds from the start; or state the rate instead "
          "(`rate`)}"
          "{?as=complex|must be one such as (1.5+2e-3j); or name magnitude and phase, or real and imaginary "
          "part}"
          "{!as|must be a number such as -1{decimal_mark}5e-3}"},

      // Samples
      ProblemPhrase{too_many_samples_missing, "too_many_samples_missing",
                    "{?sample|sample {sample:n}: }is NaN, infinite or empty, the first of {missing:n} such samples "
                    "among {samples:n}",
                    "at most 1 % may be missing"},
      ProblemPhrase{sample_too_large, "sample_too_large",
                    "{?sample|sample {sample:n}: }{?value|is {value:.6g}{?scale| with the scale {scale:.6g}}}"
                    "{!value|the value is too large for the scale {scale:.6g}}",
                    "{?value|must be below 1e100 in magnitude, as any force and motion is; a damaged cell?}"
                    "{!value|must be below 1e308 after scaling}"},
      ProblemPhrase{too_many_rows_lost, "too_many_rows_lost",
                    "{?sample|sample {sample:n}: }{lost:n} of {rows:n} rows are lost, the first before this one, and "
                    "the signals change too much from row to row to tell what they held; the longest stretch without "
                    "such a gap has {used:n} rows",
                    "log every row, or excite more slowly: a chirp or a multisine below a fifth of the rate"},

      // Times
      ProblemPhrase{no_times, "no_times",
                    "{?of=flags|do not say whether times are in ms or us}"
                    "{?of=step|the segment states no Delta_X for {column}}"
                    "{?of=start|segment {segment:n} states no date and time}"
                    "{!of|has no column {?samples|of {samples:n} samples }whose name says time}",
                    "{?of=flags|must have one of the bits 16 and 32; or state the unit (`time_scale`), or the rate "
                    "(`rate`)}"
                    "{?of=step|must be above 0, or state the rate (`rate`)}"
                    "{?of=start|must be such as 2013/02/19 and 09:51:40.7; or state the rate (`rate`)}"
                    "{!of|state the rate in Hz (`rate`) or the column of times (`time_column`)"
                    "{?names|; the file has {columns:n} column{columns:s}: {names}}{?rates|; the file has {rates}}}"},
      ProblemPhrase{asked_for_beside, "asked_for_beside",
                    "a column of {?of=times|times is asked for beside a rate}"
                    "{?of=frequencies|frequencies is asked for beside a step of frequency}",
                    "must be one of the two"},
      ProblemPhrase{no_column_of_times, "no_column_of_times", "has its times in column {column:n}",
                    "must be one of the {columns:n} columns, from 0 on"},
      ProblemPhrase{times_not_rising, "times_not_rising",
                    "{?sample|sample {sample:n}: }the time {?after|falls from {time:.12g} to {after:.12g}}"
                    "{!after|stands still at {time:.12g}, {times:n} times in the record}",
                    "times must rise"
                    "{?bits|: this looks like a timer of {bits:n} bits that wraps (`timer_bits` {bits:n})}"
                    "{!bits|{?after|, or}{!after|: where they have too few digits or are repeated,} state the rate "
                    "instead (`rate`)}"},
      ProblemPhrase{no_timer_count, "no_timer_count", "{?sample|sample {sample:n}: }is {value:.17g}",
                    "a timer of {bits:n} bits shows whole numbers from 0 to {most:n}"},
      ProblemPhrase{no_period_in_times, "no_period_in_times",
                    "the times are too large or too small for a sampling period", "must be times in s"},
      ProblemPhrase{value_without_time, "value_without_time", "{column} has a value and no time",
                    "must have the time of its group's column"},
      ProblemPhrase{columns_of_other_times, "columns_of_other_times",
                    "{?sample|sample {sample:n}: }has other times than {other}: {samples:n} samples from {first:.9g} s "
                    "to {last:.9g} s, {rate:.6g} Hz; {other_samples:n} samples from {other_first:.9g} s to "
                    "{other_last:.9g} s, {other_rate:.6g} Hz",
                    "columns of one recording must share their times: take columns of one time column, or record them "
                    "in one task at one rate"},

      // Responses
      ProblemPhrase{response_column_ambiguous, "response_column_ambiguous",
                    "{first} and {second} may be the {quantity}", "name the columns of the response"},
      ProblemPhrase{no_response_column, "no_response_column",
                    "{?quantity=frequency|has one column and so no frequencies}"
                    "{!quantity=frequency|{?quantity|the {quantity} has no column}"
                    "{!quantity|it is not clear which columns are the response}}",
                    "{?quantity=frequency|state the step of frequency between its lines}"
                    "{!quantity=frequency|{?quantity|name it}"
                    "{!quantity|name magnitude and phase, or real and imaginary part}; the columns are {names}}"},
      ProblemPhrase{frequency_out_of_range, "frequency_out_of_range", "{?entry|has}{!entry|is} {hertz:.6g} Hz",
                    "must be {?lowest|above the lowest, {lowest:.6g} Hz}"
                    "{?nyquist|at most half the sampling rate, {nyquist:.6g} Hz}"
                    "{?step|finite and not negative}{!lowest|{!nyquist|{!step|finite and above 0}}}"},
      ProblemPhrase{response_line_twice, "response_line_twice",
                    "{hertz:.6g} Hz {?line|is also at line {line:n},}{!line|comes twice} with the same value",
                    "must come once, or be measured again"},
      ProblemPhrase{magnitude_below_zero, "magnitude_below_zero", "the magnitude is {value:.6g}",
                    "must not be negative, unless it is in dB"},
      ProblemPhrase{no_line_in_band, "no_line_in_band", "no line is left in the band",
                    "widen it (`lowest`, `highest`)"},
      ProblemPhrase{scale_not_possible, "scale_not_possible", "is {value:exact}", "must be finite and not 0"},
  };
  return phrases;
}

}  // namespace zwidth::internal
