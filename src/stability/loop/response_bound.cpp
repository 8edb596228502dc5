#include "stability/loop/response_bound.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "infinity.hpp"
#include "sampling/term_on_circle.hpp"
#include "stability/loop/plant_fraction.hpp"

namespace zwidth::internal {
namespace {

constexpr double unit = 16.0 * std::numeric_limits<double>::epsilon();

double at(const double* c, double x) { return c[0] + x * (c[1] + x * c[2]); }

}  // namespace

// delta = -x/2 + j sin, |delta|² = x, Re delta² = x²/2 - x, Re(delta² conj delta) = -x²/2
ResponseBound::Quadratic::Quadratic(double c0, double c1, double c2)
    : coefficients{c0 * c0, c1 * c1 - c0 * c1 - 2.0 * c0 * c2, c2 * c2 + c0 * c2 - c1 * c2},
      sizes{c0 * c0, c1 * c1 + std::abs(c0 * c1) + 2.0 * std::abs(c0 * c2),
            c2 * c2 + std::abs(c0 * c2) + std::abs(c1 * c2)} {}

double ResponseBound::Quadratic::least(double begin, double end) const {
  double value = std::min(at(coefficients, begin), at(coefficients, end));
  const double turn = -0.5 * coefficients[1] / coefficients[2];
  if (begin < turn && turn < end) value = std::min(value, at(coefficients, turn));
  return std::max(0.0, value - unit * at(sizes, end));
}

double ResponseBound::Quadratic::greatest(double begin, double end) const {
  double value = std::max(at(coefficients, begin), at(coefficients, end));
  const double turn = -0.5 * coefficients[1] / coefficients[2];
  if (begin < turn && turn < end) value = std::max(value, at(coefficients, turn));
  return value + unit * at(sizes, end);
}

double ResponseBound::Quotient::greatest(double begin, double end) const {
  const double below = denominator.least(begin, end);
  if (!(below > 0.0)) return infinity;
  double above = numerator.greatest(begin, end);
  for (std::size_t i = 0; i < nyquist_zeros; ++i) above *= 4.0 - begin;  // |delta + 2|² = 4 - x
  return std::sqrt(above / below);
}

ResponseBound::ResponseBound(const FilteredPlant& plant) : plant_(plant) {
  for (const SampledTerm& term : plant.terms) {
    is_told_ = is_told_ && term.degree <= 2;
    if (!is_told_) return;
    const bool pair = term.degree == 2;
    const double* n = term.numerator;
    const double* d = term.denominator;
    terms_.push_back({{n[0], n[1], pair ? n[2] : 0.0}, {d[0], pair ? d[1] : 1.0, pair ? 1.0 : 0.0}});
  }
  for (const FilterSection& section : plant.filters) {
    const bool pair = section.degree == 2;
    const auto& n = section.numerator;
    const auto& d = section.denominator;
    const std::size_t degree = section.degree - section.nyquist_zeros;
    filters_.push_back({{n[0], degree > 0 ? n[1] : 0.0, degree > 1 ? n[2] : 0.0},
                        {d[0], pair ? d[1] : 1.0, pair ? 1.0 : 0.0},
                        section.nyquist_zeros});
  }
}

double ResponseBound::greatest(double begin, double end) const {
  if (!is_told_) return infinity;
  double bound = 0.0;
  for (const Quotient& term : terms_) bound += term.greatest(begin, end);
  if (!plant_.numerator.empty()) {  // the terms nearly cancel
    double whole = greatest_of_numerator(begin, end);
    for (const Quotient& term : terms_) whole /= std::sqrt(term.denominator.least(begin, end));
    if (!(whole > bound)) bound = whole;
  }
  for (const Quotient& filter : filters_) bound *= filter.greatest(begin, end);
  return std::isnan(bound) ? infinity : bound;
}

double ResponseBound::greatest_of_numerator(double begin, double end) const {
  const CirclePoint<BoundedJet<double>> interval = circle_interval<double>(begin, end);
  const BoundedJet<double> seen = squared_magnitude(sum_of_numerators(plant_, interval), interval);
  return std::sqrt(seen.size() + 256.0 * unit * seen.weight);
}

}  // namespace zwidth::internal
