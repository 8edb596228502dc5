#pragma once

#include <optional>

#include "zwidth/finding.hpp"
#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// How well the phase agrees with the slope of the gain, -1 to 1; nothing of fewer than 3 lines.
///
///     mean of cos(arg H - 90 degrees s),   s = d log|H| / d log w, cut to [-2, 0]
///
/// weighted by the coherence, over the lower half of the band by its logarithm, where delay and further modes turn little. A
/// minimum-phase response has 1 (Bode 1945, ch. 14), the same with its sign turned -1.
[[nodiscard]] std::optional<double> agreement_of_sign(const FrequencyResponse& response);

/// A contradiction where the position falls as the force rises.
[[nodiscard]] std::optional<Finding> turned_sign(const FrequencyResponse& response);

}  // namespace zwidth::internal
