#pragma once

#include <complex>
#include <optional>
#include <vector>

#include "zwidth/remark.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// One line of a measured response.
struct ResponsePoint {
  double frequency = 0.0;      ///< rad/s; > 0, at most pi/T
  std::complex<double> value;  ///< position per force, m/N or rad/(N m)
  double variance = 0.0;       ///< E|estimate - truth|^2 of `value`; 0: unknown
  double coherence = 1.0;      ///< ordinary coherence, 0..1 (periodic: signal to signal-and-noise power)
  /// Amplitude of the force on this line, N or N m, comparable between records that are estimated alike; 0: unknown.
  double force = 0.0;
};

/// A measured response from force to position, as the sampled controller sees it.
struct FrequencyResponse {
  /// T, s, of the record. The response is then that of the sampled plant: hold, lag and delay are in it. Absent for a
  /// table of a continuous response.
  std::optional<double> sampling_period;
  std::vector<ResponsePoint> points;  ///< by rising frequency; only lines that the force excites
  double averages = 0.0;              ///< effective number of independent averages; 0: unknown (tables)
  /// Variance of the sum of the errors of neighbouring lines over that of as many independent ones: a window correlates
  /// neighbours.
  double line_correlation = 1.0;
  std::vector<Remark> remarks;  ///< choices made, and doubts
  /// What a table says of the critical stiffness that was read off it where it was measured; absent where it says
  /// nothing.
  std::optional<Trust> trust = {};
};

}  // namespace zwidth
