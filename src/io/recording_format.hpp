#pragma once

#include <string_view>

#include "zwidth/io/recording_file.hpp"

namespace zwidth::internal {

/// What a file is, by its first bytes (512 bytes and more decide; fewer only in a smaller file): MAT, UFF, or else
/// text.
[[nodiscard]] RecordingFormat format_of(std::string_view first_bytes);

}  // namespace zwidth::internal
