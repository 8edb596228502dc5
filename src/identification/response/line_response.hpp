#pragma once

#include <optional>
#include <span>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"

namespace zwidth::internal {

/// frequency_response() at given frequencies (rad per sample, rising, below pi), whatever the record's length: by blocks
/// p of the record, the amplitudes of all lines beside a straight line by least squares, and from them H = mean X / mean
/// F with the noise that the scatter over the blocks shows. Leading blocks with a transient are left out.
/// A force that is one of the lines alone is asked for that line only; a sine of less than three periods is fitted in one
/// piece, its noise that of the frequencies beside it. From force to `output` as it is. Throws Error where the record is too short to tell the lines apart.
[[nodiscard]] FrequencyResponse line_response(std::span<const double> force, std::span<const double> output,
                                              double sampling_period, const std::vector<double>& angles,
                                              const FrequencyResponseOptions& options, const Progress& progress);

/// The angle per sample of a force that is one sine, with noise, and nothing else.
[[nodiscard]] std::optional<double> only_tone(std::span<const double> force);

}  // namespace zwidth::internal
