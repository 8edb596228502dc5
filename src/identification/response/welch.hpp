#pragma once

#include <span>

#include "zwidth/identification/frequency_response.hpp"

namespace zwidth::internal {

/// frequency_response() by averaging over windowed segments, from force to `output` as it is (a velocity is not turned
/// into a position). The arguments are valid and the force is not constant.
[[nodiscard]] FrequencyResponse welch_response(std::span<const double> force, std::span<const double> output,
                                               double sampling_period, const FrequencyResponseOptions& options,
                                               const Progress& progress);

/// The record begins where the device is at rest and the force is nil, as that of a sweep does. More than 8 samples.
[[nodiscard]] bool begins_at_rest(std::span<const double> force, std::span<const double> output);

/// Samples of the segments that welch_response() cuts a record of that many samples into.
[[nodiscard]] std::size_t welch_segment_length(std::size_t samples, const FrequencyResponseOptions& options);

}  // namespace zwidth::internal
