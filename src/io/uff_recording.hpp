#pragma once

#include <string>
#include <tl/expected.hpp>

#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// Reads time records (dataset 58 or 58b, function type 1) of a universal file as the channels of a recording.
///
/// A record is named by an ID line, by its response point ("12+Z": node and direction), or by its number from 1 among
/// all records of the file. The records asked for must share one time axis: without `rate` and `time_column` it
/// is that of the records themselves.
[[nodiscard]] tl::expected<Recording, InputError> read_uff_recording(const std::string& path,
                                                                     const RecordingOptions& options,
                                                                     const Progress& progress = {});

/// The records of a universal file, time records and others.
[[nodiscard]] tl::expected<RecordingContents, InputError> list_uff_recording(const std::string& path,
                                                                             const RecordingOptions& options = {},
                                                                             const Progress& progress = {});

}  // namespace zwidth::internal
