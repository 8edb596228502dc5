#pragma once

#include <span>

#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/signal/recording.hpp"

namespace zwidth {

/// A structure fitted to a record, and the response that it was fitted to.
struct RecordFit {
  ParameterFit fit;            ///< of the parameters
  FrequencyResponse response;  ///< that they were fitted to
};

/// Fits a device to a record of force and motion: frequency_response(), fit_parameters(), without_leakage().
/// Throws Error as they do.
[[nodiscard]] RecordFit fit_record(const Device& structure, std::span<const double> force,
                                   std::span<const double> output, double sampling_period,
                                   const FrequencyResponseOptions& response_options = {},
                                   const ParameterFitOptions& fit_options = {}, const Progress& progress = {});

/// Fits again to the response without the leakage of its segments.
///
/// Where segments are averaged (Welch), motion that rings on from one into the next is an error of the response,
/// largest at resonances and low frequencies. With the motion y_M of the fitted device under the recorded force, from
/// rest,
///
///     P = P_M + H1(force -> y - y_M)        exact for any linear device
///
/// and only the small rest y - y_M leaks. Repeated until the parameters stand still, at most three times; a round that
/// does not lower the noise is dropped. Nothing changes where whole periods are averaged, or the output is no position.
/// `first` is a fit to the response of the same recordings (force, motion) with the same options. Throws Error as its parts do.
[[nodiscard]] RecordFit without_leakage(RecordFit first, std::span<const Recording> recordings,
                                        const FrequencyResponseOptions& response_options,
                                        const ParameterFitOptions& fit_options);

}  // namespace zwidth
