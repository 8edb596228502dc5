#pragma once

#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// The points between options.lowest and options.highest. Throws Error (invalid_argument) where there is none.
[[nodiscard]] FrequencyResponse band_of(const FrequencyResponse& response, const ParameterFitOptions& options);

/// Puts the lines of the band into `fit`, with the response of its device beside them and how well they agree.
///
///     misfit^2 = mean |r_k|^2 / variance_k,    model_error^2 = median (|r_k|^2 - variance_k) / |H_k|^2, 0 at least
void compare_with_response(ParameterFit& fit, const FrequencyResponse& response, const ParameterFitOptions& options);

}  // namespace zwidth::internal
