#include "design/region/boundary_curve.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "sampling/extended_sampling.hpp"
#include "stability/loop/delay_factor.hpp"
#include "stability/loop/plant_fraction.hpp"

namespace zwidth::internal {
namespace {

// The plant with its numerators added up. Bounds of a sum of terms that partly cancel are far too wide; those of one
// polynomial are not.
FilteredPlant with_one_numerator(FilteredPlant plant) {
  if (!plant.numerator.empty() || plant.terms.size() < 2) return plant;
  std::vector<ExtendedTerm> terms;
  for (const SampledTerm& term : plant.terms) {
    ExtendedTerm extended;
    extended.numerator.assign(term.numerator, term.numerator + term.degree + 1);
    extended.denominator.assign(term.denominator, term.denominator + term.degree);
    extended.denominator.emplace_back(1.0);
    terms.push_back(std::move(extended));
  }
  plant.numerator = common_numerator(terms);
  return plant;
}

}  // namespace

BoundaryCurve::BoundaryCurve(FilteredPlant plant, double velocity_filter_hz)
    : plant_(std::move(plant)),
      bounded_plant_(with_one_numerator(plant_)),
      velocity_filter_hz_(velocity_filter_hz),
      c_(velocity_filter_gain(velocity_filter_hz, plant_.period)) {}

template <typename Real>
BoundaryCurve::Numerators<Real> BoundaryCurve::numerators(const Real& x, const Real& even, const Real& odd) const {
  const double scale = plant_.period / (c_ * c_);
  return {(1.0 / c_ - 0.5) * (x * odd) - even, -(scale * (((1.0 - c_) * x + c_ * c_) * odd))};
}

WallPoint BoundaryCurve::at(double angle) const {
  const CirclePoint<double> point = circle_point(angle);
  const auto [s, d] = plant_fraction(plant_, point);
  OnCircle<double> product = multiply(d, conj(s), point);
  if (plant_.delay_samples > 0) product = multiply(product, delay_factor(plant_.delay_samples, angle), point);
  const double scale = 1.0 / squared_magnitude(s, point);
  const auto [stiffness, damping] = numerators(point.chord_squared, product.even, product.odd);
  return {stiffness * scale, damping * scale};
}

BoundaryCurve::Model BoundaryCurve::model(double begin, double end) const {
  const CirclePoint<Jet> interval = circle_interval<double>(begin, end);
  const auto [s, d] = plant_fraction(bounded_plant_, interval);
  OnCircle<Jet> product = multiply(d, conj(s), interval);
  if (plant_.delay_samples > 0) {
    product = multiply(product, delay_factor<double>(plant_.delay_samples, begin, end), interval);
  }
  const auto [stiffness, damping] = numerators(interval.chord_squared, product.even, product.odd);
  return {stiffness, damping, squared_magnitude(s, interval), squared_magnitude(d, interval)};
}

// v = (c/T) delta / (delta + c)
std::complex<double> BoundaryCurve::velocity(double angle) const {
  const std::complex<double> delta(-0.5 * circle_point(angle).chord_squared, std::sin(angle));
  return c_ / plant_.period * delta / (delta + c_);
}

double BoundaryCurve::velocity_at_nyquist() const { return 2.0 * c_ / (plant_.period * (2.0 - c_)); }

double BoundaryCurve::nyquist_stiffness() const {
  if (nyquist_zeros(plant_) > 0) return 0.0;
  return -1.0 / response(plant_, std::numbers::pi / plant_.period).real();
}

}  // namespace zwidth::internal
