#pragma once

#include <span>
#include <vector>

namespace zwidth {

/// How a signal's power is spread over the frequencies.
struct PowerDensity {
  double step_hz = 0.0;        ///< between neighbouring values
  std::vector<double> values;  ///< one-sided, (signal's unit)^2 / Hz, at k step_hz from 0 to half the rate
};

/// Power spectral density of the whole signal without a window, or its mean over consecutive blocks.
///
///     S(k df) = c |X_k|^2 / (rate n),  c = 1 at 0 and Nyquist, else 2,  df = rate / n;   sum_k S df = mean square
///
/// No window, so that swept signals are not shaped and periodic ones stay lines. n: all samples up to 2^20, else blocks
/// of 2^20, an incomplete last one left out. Requires at least two finite samples and rate > 0; throws Error
/// (invalid_argument) otherwise.
[[nodiscard]] PowerDensity power_density(std::span<const double> signal, double rate);

}  // namespace zwidth
