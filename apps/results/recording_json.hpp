#pragma once

#include "results/json.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth::results {

/// What a recording file holds as a JSON document, schema "zwidth.recording/1": format, columns, remarks.
[[nodiscard]] Json recording_json(const RecordingContents& contents);

}  // namespace zwidth::results
