#pragma once

#include <cmath>
#include <complex>

namespace zwidth::internal {

// Of a pole z, given as z - 1, with every digit beside the unit circle: log |z|.
inline double log_modulus(std::complex<double> pole_minus_one) {
  return 0.5 * std::log1p(2.0 * pole_minus_one.real() + std::norm(pole_minus_one));
}

// The same: |z| - 1 = (2 Re d + |d|²)/(|1 + d| + 1), d = z - 1.
inline double modulus_minus_one(std::complex<double> pole_minus_one) {
  return (2.0 * pole_minus_one.real() + std::norm(pole_minus_one)) / (std::abs(1.0 + pole_minus_one) + 1.0);
}

}  // namespace zwidth::internal
