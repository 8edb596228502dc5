#pragma once

// Real-coefficient functions of z on the unit circle z = e^{j angle}, split as even + j sin(angle) odd with both parts
// real and smooth. The split removes the trivial zeros of the imaginary part at z = 1 and z = -1 and keeps, as sums of
// small terms, the digits that 1 - cos(angle) would lose at fast sampling. Real is double or a BoundedJet.

#include <cmath>
#include <cstddef>

#include "model/extended_precision.hpp"

namespace zwidth::internal {

template <typename Real>
struct CirclePoint {
  Real chord_squared;  // x = |z - 1|² = 4 sin²(angle/2)
  Real sine_squared;   // sin²(angle)
};

template <typename Real>
struct OnCircle {
  Real even;
  Real odd;
};

inline double square(double a) { return a * a; }
inline Extended square(const Extended& a) { return a * a; }

inline CirclePoint<double> circle_point(double angle) {
  const double half = std::sin(angle / 2.0);
  const double sine = std::sin(angle);
  return {4.0 * half * half, sine * sine};
}

template <typename Real>
OnCircle<Real> conj(const OnCircle<Real>& a) {
  return {a.even, -a.odd};
}

template <typename Real>
OnCircle<Real> multiply(const OnCircle<Real>& a, const OnCircle<Real>& b, const CirclePoint<Real>& point) {
  return {a.even * b.even - point.sine_squared * (a.odd * b.odd), a.even * b.odd + a.odd * b.even};
}

template <typename Real>
Real squared_magnitude(const OnCircle<Real>& a, const CirclePoint<Real>& point) {
  return square(a.even) + point.sine_squared * square(a.odd);
}

// c[0] + c[1] delta + ... (+ delta^count when leading is 1), delta = z - 1 = -x/2 + j sin(angle).
// delta² = -x + x²/2 - j sin(angle) x.
template <typename Real>
OnCircle<Real> polynomial(const double* c, std::size_t count, double leading, const CirclePoint<Real>& point) {
  const Real& x = point.chord_squared;
  if (count == 1) return {c[0] - (0.5 * leading) * x, Real(leading)};
  if (count == 2) {
    return {c[0] - (0.5 * c[1] + leading) * x + (0.5 * leading) * square(x), c[1] - leading * x};
  }
  OnCircle<Real> value{Real(leading), Real(0.0)};
  for (std::size_t i = count; i-- > 0;) {
    // times delta, plus c[i]
    const Real even = -0.5 * (x * value.even) - point.sine_squared * value.odd;
    value.odd = value.even - 0.5 * (x * value.odd);
    value.even = even + c[i];
  }
  return value;
}

// The same with the rest of each coefficient in double-double: where poles crowd the powers of delta cancel. A jet in
// double leaves the rests out: they are below its rounding.
template <typename Real>
OnCircle<Real> polynomial(const double* c, const double* rest, std::size_t count, double leading, double leading_rest,
                          const CirclePoint<Real>& point) {
  if constexpr (requires(const Real& a, const Extended& b) { a + b; }) {
    const Real& x = point.chord_squared;
    OnCircle<Real> value{Real(0.0) + (Extended(leading) + Extended(leading_rest)), Real(0.0)};
    for (std::size_t i = count; i-- > 0;) {
      const Real even = -0.5 * (x * value.even) - point.sine_squared * value.odd;
      value.odd = value.even - 0.5 * (x * value.odd);
      value.even = even + (Extended(c[i]) + Extended(rest[i]));
    }
    return value;
  } else {
    return polynomial(c, count, leading, point);
  }
}

// At a point: added up in double-double, at the x that double holds.
inline OnCircle<double> polynomial(const double* c, const double* rest, std::size_t count, double leading,
                                   double leading_rest, const CirclePoint<double>& point) {
  const Extended x(point.chord_squared);
  const CirclePoint<Extended> extended{x, x * (Extended(1.0) - x * 0.25)};
  const OnCircle<Extended> value = polynomial<Extended>(c, rest, count, leading, leading_rest, extended);
  return {internal::leading(value.even), internal::leading(value.odd)};
}

}  // namespace zwidth::internal
