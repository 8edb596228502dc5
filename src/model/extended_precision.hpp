#pragma once

// Double-double arithmetic (QD, used header-only) and a complex number over it: std::complex is unspecified for
// anything but the built-in types.

#include <qd/dd_real.h>

#include <cmath>

namespace zwidth::internal {

using Extended = dd_real;  // 106 bits

// Rounded to double.
inline double leading(double x) { return x; }
inline double leading(const Extended& x) { return x.x[0] + x.x[1]; }

template <typename Real>
struct Complex {
  Real re{0.0};
  Real im{0.0};

  Complex() = default;
  Complex(Real real, Real imaginary) : re(real), im(imaginary) {}
  explicit Complex(Real real) : re(real), im(0.0) {}
  template <typename Other>
  explicit Complex(const Complex<Other>& other) : re(other.re), im(other.im) {}

  friend Complex operator+(const Complex& a, const Complex& b) { return {a.re + b.re, a.im + b.im}; }
  friend Complex operator-(const Complex& a, const Complex& b) { return {a.re - b.re, a.im - b.im}; }
  friend Complex operator*(const Complex& a, const Complex& b) {
    return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
  }
  friend Complex operator*(const Complex& a, const Real& b) { return {a.re * b, a.im * b}; }
  friend Complex operator/(const Complex& a, const Complex& b) {
    const Real scale = Real(1.0) / (b.re * b.re + b.im * b.im);
    return {(a.re * b.re + a.im * b.im) * scale, (a.im * b.re - a.re * b.im) * scale};
  }
  Complex& operator+=(const Complex& b) { return *this = *this + b; }
  Complex& operator-=(const Complex& b) { return *this = *this - b; }
  Complex& operator*=(const Complex& b) { return *this = *this * b; }
};

template <typename Real>
Complex<Real> conj(const Complex<Real>& a) {
  return {a.re, -a.im};
}

// Magnitude in double: for pivoting and convergence tests.
template <typename Real>
double magnitude(const Complex<Real>& a) {
  const double re = leading(a.re);
  const double im = leading(a.im);
  return std::sqrt(re * re + im * im);
}

}  // namespace zwidth::internal
