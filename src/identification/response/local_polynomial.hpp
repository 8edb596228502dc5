#pragma once

#include <span>

#include "zwidth/identification/frequency_response.hpp"

namespace zwidth::internal {

/// Lines of the whole record within `spacing` of a frequency, the least for its estimate.
inline constexpr double fewest_local_lines = 6.0;

/// frequency_response() of an aperiodic record without segments, at multiples of `spacing` (rad/s, at least
/// fewest_local_lines lines of the record): from the lines k of the whole record within `spacing` of one, by least squares
///
///     X_k = (p(w_k) F_k + t(w_k)) / w_k^2,   p and t parabolas; a velocity by 1/w_k, an acceleration as it is
///
/// X, F: spectra of motion and force; p / w^2: the response, near a rigid body's; t: what leaks from the record's ends, which
/// has the response's own poles. The variance is that of what is left, over as many degrees of freedom.
/// From force to `output` as it is. The arguments are valid and the force is not constant.
/// Source: Schoukens, Vandersteen, Barbe & Pintelon, Nonparametric preprocessing in system identification, 2009.
[[nodiscard]] FrequencyResponse local_polynomial_response(std::span<const double> force, std::span<const double> output,
                                                          double sampling_period, double spacing,
                                                          const FrequencyResponseOptions& options);

/// The same, as a position in the band asked for: what frequency_response() makes of its other estimates.
[[nodiscard]] FrequencyResponse response_of_whole_record(std::span<const double> force, std::span<const double> output,
                                                         double sampling_period, double spacing,
                                                         const FrequencyResponseOptions& options);

}  // namespace zwidth::internal
