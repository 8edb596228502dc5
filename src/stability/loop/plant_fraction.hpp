#pragma once

// P = z^-L S/D of a sampled plant on the unit circle, with nothing divided: S = sum of N_k prod_{j != k} D_j,
// D = prod D_k. Real is double or Extended (a point) or BoundedJet (an interval).

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sampling/term_on_circle.hpp"
#include "sampling/unit_circle.hpp"
#include "stability/loop/bounded_jet.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

inline double value_of(double a) { return a; }
inline double value_of(const Extended& a) { return leading(a); }
template <typename Scalar>
double value_of(const BoundedJet<Scalar>& a) {
  return leading(a.value);
}

template <typename Real>
OnCircle<Real> scaled(double factor, const OnCircle<Real>& a) {
  return {factor * a.even, factor * a.odd};
}

template <typename Real>
OnCircle<Real> sum(const OnCircle<Real>& a, const OnCircle<Real>& b) {
  return {a.even + b.even, a.odd + b.odd};
}

// x = |z - 1|² from 0 (z = 1) to 4 (z = -1) is the variable of intervals: without delay every part of P is a polynomial
// of low degree in it. sin² = x (1 - x/4).
template <typename Scalar>
CirclePoint<BoundedJet<Scalar>> circle_interval(double begin, double end) {
  const Scalar x = 0.5 * (Scalar(begin) + Scalar(end));
  const double h = 0.5 * (end - begin);
  return {{x, Scalar(h), 0.0, end}, {x * (1.0 - 0.25 * x), (1.0 - 0.5 * x) * h, 0.5 * h * h, std::min(end, 1.0)}};
}

// The angle in [0, pi] of x; near pi from 4 - x, which keeps its digits.
inline double angle_of(double x) {
  return x <= 2.0 ? 2.0 * std::asin(0.5 * std::sqrt(x)) : std::numbers::pi - 2.0 * std::asin(0.5 * std::sqrt(4.0 - x));
}

template <typename Real>
struct PlantFraction {
  OnCircle<Real> numerator;    // S
  OnCircle<Real> denominator;  // D, or D with its integrators replaced
};

// Zeros of the filters at z = -1 in all.
inline std::size_t nyquist_zeros(const FilteredPlant& plant) {
  std::size_t zeros = 0;
  for (const FilterSection& section : plant.filters) zeros += section.nyquist_zeros;
  return zeros;
}

// The filters' numerators over denominators times S/D, over the size of the denominators. Of the zeros at z = -1 the
// last `left_out` are not multiplied in.
template <typename Real>
void multiply_filters(const FilteredPlant& plant, const CirclePoint<Real>& point, std::size_t left_out,
                      PlantFraction<Real>& fraction) {
  const double sine = std::sqrt(std::max(value_of(point.sine_squared), 0.0));
  for (const FilterSection& section : plant.filters) {
    OnCircle<Real> d = polynomial(section.denominator.data(), section.degree, 1.0, point);
    const double size = std::abs(value_of(d.even)) + sine * std::abs(value_of(d.odd));
    const double scale = size > 0.0 ? 1.0 / size : 1.0;
    const std::size_t degree = section.degree - section.nyquist_zeros;
    const OnCircle<Real> n = polynomial(section.numerator.data(), degree, section.numerator[degree], point);
    fraction.numerator = multiply(fraction.numerator, scaled(scale, n), point);
    fraction.denominator = multiply(fraction.denominator, scaled(scale, d), point);
  }
  const OnCircle<Real> zero{2.0 - 0.5 * point.chord_squared, Real(1.0)};  // delta + 2
  for (std::size_t i = left_out; i < nyquist_zeros(plant); ++i) {
    fraction.numerator = multiply(fraction.numerator, zero, point);
  }
}

// S and D by the recursion (S, D) <- (S D_k + N_k D, D D_k). Both are divided by the size of each D_k, a positive
// number. `integrators`: takes the place of delta^n of the term with n integrators, in D alone. `zeros_left_out`: of
// the filters' zeros at z = -1.
template <typename Real>
PlantFraction<Real> plant_fraction(const FilteredPlant& plant, const CirclePoint<Real>& point,
                                   const OnCircle<Real>* integrators = nullptr, std::size_t zeros_left_out = 0) {
  const double sine = std::sqrt(std::max(value_of(point.sine_squared), 0.0));
  OnCircle<Real> s{Real(0.0), Real(0.0)};
  OnCircle<Real> d{Real(1.0), Real(0.0)};
  OnCircle<Real> replaced{Real(1.0), Real(0.0)};
  const bool add_up = plant.numerator.empty();
  if (!add_up) s = sum_of_numerators(plant, point);
  bool first = true;
  for (const SampledTerm& term : plant.terms) {
    OnCircle<Real> d_k = denominator_of(term, 0, point);
    double scale = std::abs(value_of(d_k.even)) + sine * std::abs(value_of(d_k.odd));
    scale = scale > 0.0 ? 1.0 / scale : 1.0;
    d_k = scaled(scale, d_k);
    OnCircle<Real> n_k{Real(0.0), Real(0.0)};
    if (add_up) {
      n_k = scaled(scale, numerator_of(term, point));
    } else {
      s = scaled(scale, s);
    }
    OnCircle<Real> replaced_k = d_k;
    if (integrators != nullptr && term.integrators > 0) {
      const auto zeros = static_cast<std::size_t>(term.integrators);
      replaced_k = scaled(scale, multiply(*integrators, denominator_of(term, zeros, point), point));
    }
    if (first) {
      if (add_up) s = n_k;
      d = d_k;
      replaced = replaced_k;
      first = false;
    } else {
      if (add_up) s = sum(multiply(s, d_k, point), multiply(n_k, d, point));
      if (integrators == nullptr || &term != &plant.terms.back()) d = multiply(d, d_k, point);  // else of no more use
      if (integrators != nullptr) replaced = multiply(replaced, replaced_k, point);
    }
  }
  PlantFraction<Real> fraction{s, integrators != nullptr ? replaced : d};
  if (!plant.filters.empty()) multiply_filters(plant, point, zeros_left_out, fraction);
  return fraction;
}

}  // namespace zwidth::internal
