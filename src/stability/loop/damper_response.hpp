#pragma once

#include <cmath>
#include <complex>

#include "zwidth/sampling/filter_section.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

/// B v(e^{jwT}).
inline std::complex<double> damper_response(VirtualDamper damper, double period, double frequency) {
  if (damper.damping == 0.0) return 0.0;
  const double angle = frequency * period;
  const double filter = velocity_filter_pole(damper.velocity_filter_hz, period);
  // 1 - e^{-ja} = 2 j sin(a/2) e^{-ja/2}
  const double sine = std::sin(0.5 * angle);
  const std::complex<double> difference(2.0 * sine * sine, 2.0 * sine * std::cos(0.5 * angle));
  return damper.damping / period * difference * (1.0 - filter) / (1.0 - filter * std::polar(1.0, -angle));
}

/// What is asked for at one frequency: the wall C = g u + d with the gain g free. The stiffness beside a closed damper
/// has u = 1, d = B v; the damper alone u = v, d = 0.
struct WallResponse {
  std::complex<double> unit = 1.0;  // u
  std::complex<double> closed;      // d
};

}  // namespace zwidth::internal
