#pragma once

// A plant G(s) = N(s) / p(s) E(s), E of drive_path.hpp, by evaluation at complex s, in double or double-double. Roots of p at
// exactly s = 0, known from the structure, are divided out of p: `zero_roots` counts them. The poles of E are known
// and not among the roots sought.

#include <cstddef>
#include <vector>

#include "model/device_lengths.hpp"
#include "model/drive_path.hpp"
#include "model/extended_precision.hpp"

namespace zwidth::internal {

// `position` times E(s).
template <typename Real>
[[nodiscard]] Complex<Real> behind_drive(const Complex<Real>& position, const DrivePath& drive,
                                         const Complex<Real>& s) {
  if (drive.is_ideal()) return position;
  Complex<Real> lagged = s * Real(drive.lag);
  lagged.re += Real(1.0);
  if (drive.tracking == 0.0) return position / lagged;
  const Complex<Real> ratio = s * (Real(1.0) / Real(drive.tracking));
  Complex<Real> below = ratio;
  below.re += Real(1.0);
  Complex<Real> above = ratio + ratio;
  above.re += Real(1.0);
  return position * above / (lagged * below * below);
}

// Polynomials, ascending powers. p carries no root at zero any more.
template <typename Real>
struct PolynomialPencil {
  std::vector<Real> numerator;
  std::vector<Real> denominator;
  DrivePath drive;
  std::size_t zero_roots = 0;

  // p / p' at s.
  [[nodiscard]] Complex<Real> newton_step(const Complex<Real>& s) const {
    Complex<Real> p(denominator.back());
    Complex<Real> derivative;
    for (std::size_t i = denominator.size() - 1; i-- > 0;) {
      derivative = derivative * s + p;
      p = p * s;
      p.re += denominator[i];
    }
    return p / derivative;
  }

  [[nodiscard]] Complex<Real> gain(const Complex<Real>& s) const {
    Complex<Real> p = horner(denominator, s);
    for (std::size_t i = 0; i < zero_roots; ++i) p *= s;
    return behind_drive(horner(numerator, s) / p, drive, s);
  }

 private:
  static Complex<Real> horner(const std::vector<Real>& coefficients, const Complex<Real>& s) {
    Complex<Real> value(coefficients.back());
    for (std::size_t i = coefficients.size() - 1; i-- > 0;) {
      value = value * s;
      value.re += coefficients[i];
    }
    return value;
  }
};

// p(s) = det Q(s) s^-zero_roots, Q(s) = M s² + D s + K; G(s) = w_position' Q(s)^-1 w_force E(s).
template <typename Real>
class BodyPencil {
 public:
  std::size_t bodies = 0;
  Weights force_at;
  Weights position_of;
  std::vector<Real> mass;       // diagonal
  std::vector<Real> coupling;   // the rest of M, bodies x bodies; empty: none
  std::vector<Real> damping;    // bodies x bodies, row by row
  std::vector<Real> stiffness;  // bodies x bodies
  DrivePath drive;
  std::size_t zero_roots = 0;

  // p / p' = 1 / ((det Q)' / det Q - zero_roots / s), (det Q)' / det Q = sum u_kk' / u_kk over the pivots of Q = P L U:
  // each entry is eliminated together with its derivative.
  [[nodiscard]] Complex<Real> newton_step(const Complex<Real>& s) const {
    fill(s);
    const std::size_t n = bodies;
    slope_.resize(n * n);
    for (std::size_t i = 0; i < n * n; ++i) slope_[i] = Complex<Real>(damping[i]);
    for (std::size_t i = 0; i < n; ++i) slope_[i * n + i] += s * (mass[i] * Real(2.0));
    for (std::size_t i = 0; i < coupling.size(); ++i) slope_[i] += s * (coupling[i] * Real(2.0));
    Complex<Real> log_slope;
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t pivot = pivot_of(k);
      if (pivot != k) {
        for (std::size_t j = k; j < n; ++j) {
          std::swap(matrix_[k * n + j], matrix_[pivot * n + j]);
          std::swap(slope_[k * n + j], slope_[pivot * n + j]);
        }
      }
      const Complex<Real> reciprocal = Complex<Real>(Real(1.0)) / matrix_[k * n + k];
      log_slope += slope_[k * n + k] * reciprocal;
      find_columns(k, [&](std::size_t j) { return is_zero(matrix_[k * n + j]) && is_zero(slope_[k * n + j]); });
      for (std::size_t i = k + 1; i < n; ++i) {
        if (is_zero(matrix_[i * n + k]) && is_zero(slope_[i * n + k])) continue;
        const Complex<Real> factor = matrix_[i * n + k] * reciprocal;
        const Complex<Real> factor_slope = (slope_[i * n + k] - factor * slope_[k * n + k]) * reciprocal;
        for (const std::size_t j : columns_) {
          matrix_[i * n + j] -= factor * matrix_[k * n + j];
          slope_[i * n + j] -= factor_slope * matrix_[k * n + j] + factor * slope_[k * n + j];
        }
      }
    }
    const Complex<Real> one(Real(1.0));
    if (zero_roots > 0) log_slope -= Complex<Real>(Real(static_cast<double>(zero_roots))) / s;
    return one / log_slope;
  }

  [[nodiscard]] Complex<Real> gain(const Complex<Real>& s) const {
    factorise(s);
    for (Complex<Real>& entry : column_) entry = Complex<Real>();
    for (const auto& [body, weight] : force_at) column_[body] = Complex<Real>(Real(weight));
    solve(column_);
    Complex<Real> position;
    for (const auto& [body, weight] : position_of) position += column_[body] * Real(weight);
    return behind_drive(position, drive, s);
  }

 private:
  static bool is_zero(const Complex<Real>& a) { return a.re == 0.0 && a.im == 0.0; }

  // Q(s)
  void fill(const Complex<Real>& s) const {
    const std::size_t n = bodies;
    matrix_.resize(n * n);
    const Complex<Real> s2 = s * s;
    for (std::size_t i = 0; i < n * n; ++i) {
      matrix_[i] = s * damping[i];
      matrix_[i].re += stiffness[i];
    }
    for (std::size_t i = 0; i < n; ++i) matrix_[i * n + i] += s2 * mass[i];
    for (std::size_t i = 0; i < coupling.size(); ++i) matrix_[i] += s2 * coupling[i];
  }

  [[nodiscard]] std::size_t pivot_of(std::size_t k) const {
    std::size_t pivot = k;
    double largest = magnitude(matrix_[k * bodies + k]);
    for (std::size_t i = k + 1; i < bodies; ++i) {
      if (is_zero(matrix_[i * bodies + k])) continue;
      const double size = magnitude(matrix_[i * bodies + k]);
      if (!(size > largest)) continue;
      largest = size;
      pivot = i;
    }
    return pivot;
  }

  // Beyond k, those that are not left out: a body is linked to a few others.
  template <typename LeftOut>
  void find_columns(std::size_t k, const LeftOut& left_out) const {
    columns_.clear();
    for (std::size_t j = k + 1; j < bodies; ++j) {
      if (!left_out(j)) columns_.push_back(j);
    }
  }

  // LU of Q(s) with partial pivoting.
  void factorise(const Complex<Real>& s) const {
    const std::size_t n = bodies;
    fill(s);
    column_.resize(n);
    pivots_.resize(n);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t pivot = pivot_of(k);
      pivots_[k] = pivot;
      if (pivot != k)
        for (std::size_t j = 0; j < n; ++j) std::swap(matrix_[k * n + j], matrix_[pivot * n + j]);
      const Complex<Real> reciprocal = Complex<Real>(Real(1.0)) / matrix_[k * n + k];
      find_columns(k, [&](std::size_t j) { return is_zero(matrix_[k * n + j]); });
      for (std::size_t i = k + 1; i < n; ++i) {
        if (is_zero(matrix_[i * n + k])) continue;
        const Complex<Real> factor = matrix_[i * n + k] * reciprocal;
        matrix_[i * n + k] = factor;
        for (const std::size_t j : columns_) matrix_[i * n + j] -= factor * matrix_[k * n + j];
      }
    }
  }

  void solve(std::vector<Complex<Real>>& x) const {
    const std::size_t n = bodies;
    for (std::size_t k = 0; k < n; ++k) {
      if (pivots_[k] != k) std::swap(x[k], x[pivots_[k]]);
    }
    for (std::size_t k = 0; k < n; ++k) {
      if (is_zero(x[k])) continue;
      for (std::size_t i = k + 1; i < n; ++i) {
        if (!is_zero(matrix_[i * n + k])) x[i] -= matrix_[i * n + k] * x[k];
      }
    }
    for (std::size_t k = n; k-- > 0;) {
      for (std::size_t j = k + 1; j < n; ++j) {
        if (!is_zero(matrix_[k * n + j])) x[k] -= matrix_[k * n + j] * x[j];
      }
      x[k] = x[k] / matrix_[k * n + k];
    }
  }

  // Scratch, so that an evaluation allocates nothing.
  mutable std::vector<Complex<Real>> matrix_;
  mutable std::vector<Complex<Real>> slope_;  // dQ/ds, eliminated with it
  mutable std::vector<Complex<Real>> column_;
  mutable std::vector<std::size_t> pivots_;
  mutable std::vector<std::size_t> columns_;  // of a pivot's row, not zero
};

}  // namespace zwidth::internal
