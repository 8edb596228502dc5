#pragma once

#include <span>
#include <string>

#include "zwidth/identification/identification.hpp"

namespace zwidth::internal {

/// Whether the response is taken at the lines of a force, by one of the recordings at least, and not from segments.
[[nodiscard]] bool is_of_lines(std::span<const Recording> recordings, const FrequencyResponseOptions& options);

/// Of a response's segments, by the least spacing of its lines, of which it has one at least, s.
[[nodiscard]] double segment_duration(const FrequencyResponse& response);

/// The response, in segments long enough that the excited band holds lines for the structure's parameters.
[[nodiscard]] MeasuredResponse response_with_enough_lines(std::span<const Recording> recordings,
                                                          const Device& structure, const IdentifyOptions& options,
                                                          const Progress& progress);

/// Why a recording has no line under these options, with the remedy.
[[noreturn]] void refuse_nothing_left(const Recording& recording, const FrequencyResponseOptions& options);

}  // namespace zwidth::internal
