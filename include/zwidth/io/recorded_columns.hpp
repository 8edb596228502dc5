#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/io/input_error.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {

/// Samples in memory, as the column of a file would hold them.
struct RecordedColumn {
  std::string name;             ///< as its header has it
  std::vector<double> samples;  ///< NaN or infinite where there is none
  /// Index of the column that holds the times of these samples; absent: the recording's one column of times, or none.
  std::optional<std::size_t> time_column = {};
};

/// Signals that were recorded together and lie in memory, not in a file.
struct RecordedColumns {
  std::string source;                     ///< what messages call them
  std::vector<RecordedColumn> columns;    ///< names that differ
  std::optional<double> sampling_period;  ///< s; what the recording itself states, where it does
};

/// The first impossible thing about them, with its column or "sampling_period": a period that is not finite and > 0, no
/// column, columns of fewer than two samples, a column of times that is none of them, columns of another size than the first
/// or, where they have a column of times of their own, than that.
[[nodiscard]] std::optional<InputError> find_problem(const RecordedColumns& recorded);

/// Reads the asked-for columns as read_recording() reads those of a file: the same choice of columns and of the time
/// axis, the same checks, scales, fillings and remarks. Columns with times of their own are put together by equal times.
///
/// Refused, besides: what find_problem() says.
[[nodiscard]] tl::expected<Recording, InputError> read_recording(const RecordedColumns& recorded,
                                                                 const RecordingOptions& options);

/// Their names and sizes.
[[nodiscard]] RecordingContents list_recording(const RecordedColumns& recorded);

}  // namespace zwidth
