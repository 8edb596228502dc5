#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// Another fit of an answer's response, which starts from a device. Nothing where no number is free, or of numbers that make no
/// device.
[[nodiscard]] std::optional<ParameterFit> fitted_from(DeviceParameters start, std::vector<std::string> free,
                                                      const Identification& result, const IdentifyOptions& options);

/// Whether no parameter has moved by a notable part of its standard deviation, from one fit of a structure to another.
[[nodiscard]] bool stands_still(const ParameterFit& before, const ParameterFit& after);

[[nodiscard]] bool explains_more(const ParameterFit& one, const ParameterFit& other);

/// Whether another fit leaves no more than chance may: by Student's t, of as many degrees of freedom as independent
/// residuals exceed the free parameters,
///
///     (chi^2 / chi_first^2 - 1) nu <= t_nu^2
[[nodiscard]] bool explains_as_much(const ParameterFit& other, const ParameterFit& first, double line_correlation);

/// Whether another fit of a response leaves so much less that not even five deviations of what tells them apart account for it:
/// of chi^2 by the other's residuals, with what the first leaves unexplained counted as noise. The three lines that gain most do
/// not count (of few periods the variance of a line is a guess), nor does less than a tenth of all.
[[nodiscard]] bool explains_notably_more(const ParameterFit& other, const ParameterFit& first,
                                         const FrequencyResponse& response);

/// Whether another fit leaves so much more that not even five deviations of what tells them apart account for it.
[[nodiscard]] bool is_contradicted(const ParameterFit& other, const ParameterFit& first, double line_correlation);

}  // namespace zwidth::internal
