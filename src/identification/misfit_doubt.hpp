#pragma once

#include <optional>
#include <string>

#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// Median over the lines of the noise's deviation as a share of the response.
[[nodiscard]] double median_noise(const FrequencyResponse& response);

/// Whether what a fit leaves is the arithmetic's, of a record without noise: a millionth of the response.
[[nodiscard]] bool is_rounding(const ParameterFit& fit, const FrequencyResponse& response);

/// Whether what a fit leaves is more than the noise of a right structure, over all lines or anywhere.
[[nodiscard]] bool stands_out(const ClearMisfit& left, const FrequencyResponse& response);

/// Whether a fit leaves more than a right structure's noise: perhaps that of a side minimum.
[[nodiscard]] bool leaves_too_much(const ParameterFit& fit, const FrequencyResponse& response);

/// Why a fit leaves more of the response than its noise, over all lines or anywhere; nothing where it does not.
[[nodiscard]] std::optional<Finding> doubt_of_misfit(const ParameterFit& fit, const FrequencyResponse& response);

}  // namespace zwidth::internal
