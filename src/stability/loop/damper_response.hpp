#pragma once

#include <cmath>
#include <complex>

#include "zwidth/sampling/filter_section.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

/// 1 - e^{-ja} = 2 j sin(a/2) e^{-ja/2}, to its own digits where it is small.
inline std::complex<double> backward_difference(double angle) {
  const double sine = std::sin(0.5 * angle);
  return {2.0 * sine * sine, 2.0 * sine * std::cos(0.5 * angle)};
}

/// B v of one damper at many frequencies, where z turns so that 1 - 1/z is `difference`.
class DamperResponse {
 public:
  DamperResponse(VirtualDamper damper, double period)
      : filter_(velocity_filter_pole(damper.velocity_filter_hz, period)),
        gain_(damper.damping / period * (1.0 - filter_)) {}

  [[nodiscard]] std::complex<double> at(std::complex<double> difference) const {
    const std::complex<double> velocity = gain_ * difference;
    return filter_ == 0.0 ? velocity : velocity / (1.0 - filter_ + filter_ * difference);
  }

 private:
  double filter_;
  double gain_;
};

/// B v(e^{jwT}).
inline std::complex<double> damper_response(VirtualDamper damper, double period, double frequency) {
  if (damper.damping == 0.0) return 0.0;
  return DamperResponse(damper, period).at(backward_difference(frequency * period));
}

/// What is asked for at one frequency: the wall C = g u + d with the gain g free. The stiffness beside a closed damper
/// has u = 1, d = B v; the damper alone u = v, d = 0.
struct WallResponse {
  std::complex<double> unit = 1.0;  // u
  std::complex<double> closed;      // d
};

}  // namespace zwidth::internal
