#pragma once

#include <complex>

namespace zwidth::internal {

/// sum over k >= first of e^{-j angle k} (k + x)^-power, power >= 2, first + x > 0.
///
///     e^{-j angle first} / Gamma(power) int_0^inf t^{power - 1} e^{-(first + x) t} / (1 - e^{-j angle - t}) dt
///
/// by Gauss-Laguerre quadrature, whose error grows as the pole at t = -j angle comes near: relative
/// to the same sum without its turning factor at most 2e-9 or 0.05 e^{-3 first |angle|}, whatever is more, for
/// first >= 6, |angle| <= pi and powers 2 and 4 (1e-13 at angle 0), measured against direct sums.
[[nodiscard]] std::complex<double> alias_tail(double first, double x, double angle, int power);

}  // namespace zwidth::internal
