#pragma once

#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "io/raw_column.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// Makes the recording of the asked-for columns (one per request, in order) and the column of times that they share:
/// fills what little is missing, scales, leaves out rows that are repeated, restores equal steps (restored_rows()), and
/// adds remarks on all of it. Beside `options.rate` the times say which rows were lost, and whether they contradict it.
/// `period`: what the file itself states, s, where there is no rate and no column of times.
[[nodiscard]] tl::expected<Recording, InputError> make_recording(std::vector<RawColumn> columns,
                                                                 std::optional<RawColumn> times,
                                                                 const RecordingOptions& options,
                                                                 std::optional<double> period = {});

/// Throws Error (invalid_argument) without columns to read, and where find_problem(options) finds one.
void check_recording_options(const RecordingOptions& options);

}  // namespace zwidth::internal
