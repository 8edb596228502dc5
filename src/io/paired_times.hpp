#pragma once

#include <tl/expected.hpp>
#include <vector>

#include "io/raw_column.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// A column and the times of its rows, in the unit that the times' name states.
struct TimedColumn {
  RawColumn values;
  RawColumn times;  ///< as many
};

/// Cuts columns with times of their own to the rows that all have: those of their common span, in which each must have
/// the same stamps, to a thousandth of a period. Returns a remark on what was left out.
/// Refused, with both names: stamps that differ within the span, as those of another rate, and no common span of two
/// rows. Rows of different times are never put together.
[[nodiscard]] tl::expected<std::vector<Remark>, InputError> keep_common_rows(std::vector<TimedColumn>& columns,
                                                                             const RecordingOptions& options);

}  // namespace zwidth::internal
