#pragma once

#include <complex>
#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"

namespace zwidth::internal {

/// What one line of a response says about its phase relative to -180 degrees.
struct PhaseLine {
  double frequency = 0.0;  ///< rad/s
  std::complex<double> value;
  double deviation = 0.0;  ///< phase - (-180 degrees), rad, in (-pi, pi]
  double sigma = 0.0;      ///< standard deviation of real and of imaginary part
  /// -Im(value) / sigma, bounded: positive where the phase lies above -180 degrees. 0 where the line is not measured.
  double evidence = 0.0;
  bool measured = true;  ///< the noise leaves the phase known within 30 degrees
};

/// The lines of a response with their noise. A line that is real by nature, at the Nyquist frequency, says nothing
/// about the phase and is left out.
///
/// sigma is the larger of what the line's own variance says, and of how far the line stands off its neighbours: a
/// nonlinear device repeats its distortions in every period, where they look like a response.
[[nodiscard]] std::vector<PhaseLine> phase_lines(const FrequencyResponse& response);

/// The line at the Nyquist frequency, if it is there.
[[nodiscard]] std::optional<ResponsePoint> nyquist_point(const FrequencyResponse& response);

}  // namespace zwidth::internal
