#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/io/input_error.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/signal/frequency_response.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth {

/// What a recording file may be. `detect` decides by content, never by the file's name alone.
enum class RecordingFormat {
  detect,
  text,  ///< CSV, TSV, semicolons, blanks
  mat,   ///< MAT v5 or v7.3
  uff,   ///< universal file, dataset 58 or 58b
};

/// A column to read: its name in the header, a variable or struct field ("run.position") of a MAT file, the name of a
/// UFF record, or its number from 1. Its samples are multiplied by `scale` (mm to m: 1e-3); where that is 1 or -1, by the
/// unit in its name too ("x [mm]", "x_mm", "angle_deg"), and a remark says so.
struct ColumnRequest {
  std::string name;  ///< of the column, or its number from 1
  /// What its samples are multiplied by, to get SI units; 1 and -1: beside the unit in its name. Absent: by that alone;
  /// a unit that is not known then counts as none of a force or motion.
  std::optional<double> scale = {};
};

/// How to read a recording. What is absent is detected.
struct RecordingOptions {
  RecordingFormat format = RecordingFormat::detect;  ///< of the file
  std::vector<ColumnRequest> columns;                ///< required; become the recording's channels, in this order

  // The time axis: a rate, or a column of times; with neither, a column whose name says time, or what the file states.
  std::optional<double> rate;              ///< Hz
  std::optional<std::string> time_column;  ///< name or number; absent: found by its name
  /// s per unit of the time column (milliseconds: 1e-3); absent: what the unit in its name says ("t [ms]"), else 1
  std::optional<double> time_scale;
  std::optional<unsigned> timer_bits;  ///< the time column counts up and wraps at 2^timer_bits

  // Text only.
  /// Lines that are passed over before anything is read. Above 0, what follows is read as a table, never as the export
  /// of a measuring program.
  std::size_t skip_rows = 0;
  std::optional<char> delimiter;     ///< comma, semicolon, tab or space (any run of blanks)
  std::optional<char> decimal_mark;  ///< absent: detected
  /// Whether the first line of a text names the columns.
  enum class Header { detect, present, absent } header = Header::detect;  ///< detect: by what stands in it
  std::string comment = "#%";  ///< lines that begin with one of these are skipped

  /// Bytes that a MAT file's compressed variables may unpack to, all together; more is refused.
  std::size_t most_unpacked = std::numeric_limits<std::size_t>::max();
};

/// Checks what the options say by themselves: rate and time_scale finite and above 0, scales ("columns.0.scale", ...)
/// finite and not 0, delimiter and decimal_mark different.
[[nodiscard]] std::optional<OptionProblem> find_problem(const RecordingOptions& options);

/// Reads the asked-for columns of a recording ("-": standard input, text only).
///
/// Text is streamed: memory is that of the columns asked for, whatever the file's size. The time column is checked:
/// unwrapped where a timer wraps, refused where it falls back or stands still otherwise, and resampled never: periods
/// that differ from their mean by more than 1 % (jitter) or gaps (a period of 1.5 or more that its neighbours do
/// not make up) are remarked with their place and meaning. NaN, infinities and empty cells are refused with their line
/// unless they are at most 1 % of a column; those are filled linearly and remarked. A missing column's error lists what
/// the file has.
///
/// A text that begins with the header of a measuring program is read as its export: TwinCAT Scope (CSV), CODESYS
/// (*.trace.csv), LabVIEW (.lvm), dSPACE ControlDesk (CSV). Their lines of metadata are no samples. Columns with times of
/// their own are put together by equal times, in their common span; where times differ within it, they are refused. A
/// scale that a header states without saying whether it is applied is a doubt, unless the column's scale is given.
///
/// A MAT file's MATLAB objects (tables, timeseries) are skipped with a remark; a file of nothing else is
/// refused.
[[nodiscard]] tl::expected<Recording, InputError> read_recording(const std::string& path,
                                                                 const RecordingOptions& options,
                                                                 const Progress& progress = {});

/// What a recording file holds, for "what columns are there?".
struct RecordingColumn {
  std::string name;      ///< as the file has it, or its number from 1
  std::size_t size = 0;  ///< samples
  std::string detail;    ///< "double 50000x1", "time record, 0.0004 s", "frequency response"; may be empty
  std::string unit =
      {};  ///< as its name states it, "mNm" of "torque_mNm": the reader scales by it; empty: nothing for sure
};

/// What a recording file holds, before columns are chosen.
struct RecordingContents {
  RecordingFormat format = RecordingFormat::text;  ///< never detect
  std::vector<RecordingColumn> columns;            ///< in the order of the file
  std::vector<Remark> remarks;                     ///< what was skipped and why
};

/// The columns of a file, before any is chosen.
[[nodiscard]] tl::expected<RecordingContents, InputError> list_recording(const std::string& path,
                                                                         const RecordingOptions& options = {},
                                                                         const Progress& progress = {});

/// Which column of a table is what. Names, or numbers from 1; the first set of three that is given counts. Where none
/// is, columns whose names say what they are ("frequency_hz", "mag [dB]", "phase (rad)", "re"). Units that are not
/// given are those that the names state, with a remark.
struct ResponseTableOptions {
  RecordingOptions file;  ///< format, delimiter, decimal mark, header, comment; `columns` and time are not used
  std::string frequency;  ///< empty: a column named f, freq, frequency, ..., or the first (a UFF record has its own)
  std::optional<double> frequency_scale;  ///< rad/s per unit; absent: as the name says, else Hz
  std::string magnitude;                  ///< with `phase`; or
  std::string phase;                      ///< beside `magnitude`
  std::string real;                       ///< with `imaginary`, or a column of complex numbers "(re+imj)"
  std::string imaginary;                  ///< beside `real`
  bool magnitude_in_db = false;           ///< else as a factor
  std::optional<bool> phase_in_degrees;   ///< absent: as the name says, else degrees
  double scale = 1.0;                     ///< of the value
  std::optional<std::string> coherence;   ///< a column, where there is one
  /// s: the table is the sampled plant's response; absent: that of file.rate, and without that it is continuous.
  std::optional<double> sampling_period;
  double frequency_step = 0.0;    ///< rad/s, for a list of values without frequencies: they are k step, k >= 0
  std::optional<double> lowest;   ///< rad/s; lines outside are left out
  std::optional<double> highest;  ///< rad/s
};

/// Checks what the options say by themselves: scales, step and sampling period, `lowest` below `highest`, and
/// find_problem(options.file).
[[nodiscard]] std::optional<OptionProblem> find_problem(const ResponseTableOptions& options);

/// Between the reasons in a cell of a table's column `trust_reasons`.
inline constexpr const char* between_reasons = " | ";

/// Reads a frequency response: a text table, or a UFF record that is one (function type 4; `real` names the record). A
/// table's columns `trust` and `trust_reasons`, as zwidth writes them, become its trust.
[[nodiscard]] tl::expected<FrequencyResponse, InputError> read_response_table(const std::string& path,
                                                                              const ResponseTableOptions& options,
                                                                              const Progress& progress = {});

}  // namespace zwidth
