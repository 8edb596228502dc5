#pragma once

// The polynomials of a sampled plant on the unit circle; Real is double (a point) or BoundedJet (an interval).

#include <cstddef>

#include "sampling/unit_circle.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// Whether what rounding to double left out of the term's coefficients is kept: poles that crowd, or lie so near the unit
// circle that rounding would move them across.
inline bool keeps_rests(const SampledTerm& term) {
  return term.degree > 2 || term.denominator_rest[0] != 0.0 || term.denominator_rest[1] != 0.0;
}

// A numerator or denominator of a term.
template <typename Real>
OnCircle<Real> denominator_of(const SampledTerm& term, std::size_t from, const CirclePoint<Real>& point) {
  const std::size_t count = term.degree - from;
  if (!keeps_rests(term)) return polynomial(term.denominator + from, count, 1.0, point);
  return polynomial(term.denominator + from, term.denominator_rest + from, count, 1.0, 0.0, point);
}
template <typename Real>
OnCircle<Real> numerator_of(const SampledTerm& term, const CirclePoint<Real>& point) {
  const std::size_t n = term.degree;
  if (!keeps_rests(term)) return polynomial(term.numerator, n, term.numerator[n], point);
  return polynomial(term.numerator, term.numerator_rest, n, term.numerator[n], term.numerator_rest[n], point);
}
// Where the terms' sum is kept as one polynomial.
template <typename Real>
OnCircle<Real> sum_of_numerators(const SampledPlant& plant, const CirclePoint<Real>& point) {
  const std::size_t n = plant.numerator.size() - 1;
  if (plant.numerator_rest.empty()) return polynomial(plant.numerator.data(), n, plant.numerator[n], point);
  return polynomial(plant.numerator.data(), plant.numerator_rest.data(), n, plant.numerator[n], plant.numerator_rest[n],
                    point);
}

}  // namespace zwidth::internal
