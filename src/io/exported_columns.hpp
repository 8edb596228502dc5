#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "io/raw_column.hpp"
#include "io/row_lines.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// value = factor raw + offset, as a header states it without saying whether its rows are raw or values.
struct StatedScale {
  double factor = 1.0;
  double offset = 0.0;
};

/// One column of the export of a measuring program.
struct ExportedColumn {
  std::string name;          ///< with its unit: "F [N]"
  std::size_t samples = 0;   ///< how many the file has
  bool holds_times = false;  ///< it is the time of others
  std::string time_name;     ///< of the column of times that its rows have: "time [ms]"; empty: none
  StatedScale scale;
  bool is_kept = false;                  ///< its numbers are
  std::vector<double> values;            ///< NaN where there is no number
  std::vector<double> times;             ///< as many, in the unit of time_name; empty: none
  bool has_lines = true;                 ///< in memory there are none
  RowLines lines;                        ///< of the values
  std::optional<InputError> unreadable;  ///< the first cell that is no number: told to who asks for the column
};

/// What the export of a measuring program holds: columns that may have times of their own, and be of different lengths.
struct ExportedColumns {
  std::string source;
  std::vector<ExportedColumn> columns;  ///< in the order of the file
  std::vector<Remark> remarks;          ///< what was read and what was passed over
  std::vector<Finding> doubts;          ///< what makes every result doubtful unless a rate is stated
};

/// Marks the columns to keep: those that the options ask for.
void mark_columns_to_keep(ExportedColumns& exported, const RecordingOptions& options);

/// The recording of the asked-for columns: rows of equal times in their common span.
/// Refused: an unknown column, a cell that is no number, and times that differ (keep_common_rows()).
[[nodiscard]] tl::expected<Recording, InputError> make_recording(ExportedColumns exported,
                                                                 const RecordingOptions& options);

/// Their names and sizes.
[[nodiscard]] RecordingContents list_exported(const ExportedColumns& exported);

}  // namespace zwidth::internal
