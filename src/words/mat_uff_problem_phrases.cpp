#include <array>

#include "words/problem_phrase.hpp"

namespace zwidth::internal {

// Of MAT files and universal files. A `byte` is where a file is damaged as a whole.
std::span<const ProblemPhrase> mat_uff_problem_phrases() {
  using enum ProblemCode;
  static constexpr const char* save_again = "save or copy the file again";
  static constexpr std::array phrases{
      ProblemPhrase{damaged_file, "damaged_file", "is a damaged MAT file of version {version}", save_again},
      ProblemPhrase{unknown_version, "unknown_version", "is a MAT file of version 4, or none",
                    "must be of version 5 or 7.3: load it in MATLAB or Octave and save it with -v7"},
      ProblemPhrase{changed_while_read, "changed_while_read", "has changed while it was read", "read it again"},
      ProblemPhrase{data_end_inside, "data_end_inside",
                    "{?byte|is damaged at byte {byte:n}: }the data end inside {part}",
                    "{?lines|must have {lines:n} lines}{!lines|save or copy the file again}"},
      ProblemPhrase{
          bytes_missing, "bytes_missing",
          "{?byte|is damaged at byte {byte:n}: }{?points|{points:n} points take }{bytes:n} bytes{!points| are "
          "announced}, {left:n} are left",
          "{?declared|the header says {declared:n} bytes: the file may be cut off or damaged}{!declared|save "
          "or copy the file again}"},
      ProblemPhrase{closing_line_missing, "closing_line_missing",
                    "the {bytes:n} bytes of {points:n} points are not followed by a line -1",
                    "the header says {declared:n} bytes: the file may be cut off or damaged"},
      ProblemPhrase{unpacks_to_more, "unpacks_to_more", "unpacks to more than {most:n} bytes",
                    "at most {most:n} bytes{?in_all| in all}"},
      ProblemPhrase{does_not_unpack, "does_not_unpack", "does not unpack to a variable", save_again},
      ProblemPhrase{zlib_cannot_start, "zlib_cannot_start", "zlib cannot start", ""},
      ProblemPhrase{wrong_element, "wrong_element",
                    "{?byte|is damaged at byte {byte:n}: }the element of the {part} has type {type:n} and {bytes:n} "
                    "bytes",
                    save_again},
      ProblemPhrase{wrong_field, "wrong_field", "the {field} is {value:.6g}{?first|, the first value {first:.6g}}",
                    "must be {?field=byte order|1 (little-endian) or 2 (big-endian)}{?field=number format|2 (IEEE "
                    "754): export the file as text, dataset 58}{?field=header length|11 lines}{?field=step|above 0 in "
                    "an even spacing, its first value finite}{?field=size|0 or more}{?field=name length|1 to {most:n} "
                    "bytes}"},
      ProblemPhrase{size_disagrees, "size_disagrees",
                    "{count:n} {unit}, where {?points|{points:n} points take {expected:n}}{!points|the size says "
                    "another number}",
                    "header and data must agree"},
      ProblemPhrase{nested_too_deep, "nested_too_deep", "structs are nested more than {most:n} deep",
                    "save the data as numeric arrays"},
      ProblemPhrase{has_too_many, "has_too_many",
                    "{?value|has {value:n} {what}}{!value|{?rest|and what follows: the file }has more than {most:n} "
                    "{what}}",
                    "{?what=GiB|must be split into several files}{!what=GiB|at most {most:n}{?what=values| in an "
                    "array}}"},
      ProblemPhrase{no_table, "no_table",
                    "{?dimensions|has {dimensions:n} dimensions}{!dimensions|is {rows:n}x{columns:n}: signals must be "
                    "its columns, at most {most:n}}",
                    "must be a vector, or a matrix whose columns are signals"},
      ProblemPhrase{wrong_kind, "wrong_kind",
                    "is {?class|of the unknown class {class:n}}{!class|{kind}{?columns| of {columns:n} columns}}",
                    "must be {?wanted=array|a real numeric array}{?wanted=signal|a signal}"
                    "{?wanted=column|one of them: {choices}}{?wanted=field|one of its fields: "
                    "{choices}}{?wanted=times|a real time record (function type 1)}{?wanted=response|a complex "
                    "frequency response (function type 4)}{?wanted=coherence|a real coherence (function type 6)}"},
      ProblemPhrase{lies_elsewhere, "lies_elsewhere", "lies elsewhere: behind a link or in another file",
                    "must stand in the file itself"},
      ProblemPhrase{not_read_by_hdf5, "not_read_by_hdf5", "HDF5 cannot read {?part|its {part}}{!part|it}", save_again},
      ProblemPhrase{holds_none, "holds_none",
                    "holds no {wanted}{?others|, only {others}}{?objects|, only MATLAB objects: "
                    "{objects}}{?datasets|, only datasets {datasets}}",
                    "must hold {?objects|numeric arrays: take the data out of tables and timeseries and save them as "
                    "vectors}{!objects|{?wanted=signals|numeric arrays of two samples at least}}{?wanted=function|"
                    "dataset 58 (or 58b)}{?wanted=frequency response|a complex record of function type 4}"},
      ProblemPhrase{not_one_record, "not_one_record", "holds {records:n} frequency responses",
                    "name one of them: {choices}"},
      ProblemPhrase{samples_of_two_lengths, "samples_of_two_lengths",
                    "has {samples:n} samples, {other} has {expected:n}",
                    "signals of one recording must have equally many"},
      ProblemPhrase{axes_differ, "axes_differ", "has other {axis} than {other}", "must have the same"},
      ProblemPhrase{text_not_readable, "text_not_readable",
                    "{text} {?wanted=boundary|stands outside of a dataset}{?wanted=dataset|is no number of a "
                    "dataset}{?wanted=form|is no form of data}{?wanted=type|begins with no function "
                    "type}{?wanted=number|is no number}",
                    "must be {?wanted=boundary|a universal file: a line -1, the number of a dataset, its lines, a line "
                    "-1}{?wanted=dataset|one in the first six columns, such as 58}{?wanted=form|the type (2, 4, 5 or "
                    "6), the number of points (1 to 1e9), the spacing (0 or 1), its first value and "
                    "step}{?wanted=type|a whole number in the first five columns, such as 1 (time) or 4 (frequency "
                    "response)}{?wanted=number|numbers up to the line -1}"},
      ProblemPhrase{file_without_columns, "file_without_columns", "a universal file has no columns",
                    "name the record as that of the real parts"}};
  return phrases;
}

}  // namespace zwidth::internal
