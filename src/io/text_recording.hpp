#pragma once

#include <tl/expected.hpp>

#include "io/text_lines.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// Reads the asked-for columns of a text table, as read_recording() promises.
[[nodiscard]] tl::expected<Recording, InputError> read_text_recording(TextLines lines, const RecordingOptions& options,
                                                                      const Progress& progress);

/// Names the columns of a text table and counts its rows.
[[nodiscard]] tl::expected<RecordingContents, InputError> list_text_recording(TextLines lines,
                                                                              const RecordingOptions& options,
                                                                              const Progress& progress = {});

}  // namespace zwidth::internal
