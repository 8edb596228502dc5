#pragma once

#include <complex>

namespace zwidth::internal {

/// sum over k >= first of e^{-j angle k} (k + x)^-power, power >= 2, first + x > 0.
///
///     e^{-j angle first} / Gamma(power) int_0^inf t^{power - 1} e^{-(first + x) t} / (1 - e^{-j angle - t}) dt
///
/// by Gauss-Laguerre quadrature, whose error grows as the pole at t = -j angle comes near: see alias_tail_error().
[[nodiscard]] std::complex<double> alias_tail(double first, double x, double angle, int power);

/// Bound on the error of alias_tail() relative to the same sum without its turning factor, for first >= 6 and
/// |angle| <= pi: measured against direct sums for powers 2 and 4 (tests/stability/alias_tail_test.cpp).
[[nodiscard]] double alias_tail_error(double first, double angle);

}  // namespace zwidth::internal
