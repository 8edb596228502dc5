#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "zwidth/signal/frequency_response.hpp"

namespace zwidth::internal {

/// rad/s: where what a fit leaves of a response looks like a mode that it passed over; nothing where it looks like noise.
///
///     c / (w0^2 - w^2 + j g w)
///
/// explains most of it around its peak, away from the modes that the fit has (`modes`, rad/s); or neighbouring lines that stand clear
/// of their noise leave clearly more than it.
[[nodiscard]] std::optional<double> missed_mode(const std::vector<std::complex<double>>& residuals,
                                                const FrequencyResponse& response, const std::vector<double>& modes);

}  // namespace zwidth::internal
