#include "stability/gain_locus.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stability/delay_factor.hpp"
#include "stability/plant_fraction.hpp"

namespace zwidth::internal {
namespace {

// Where an integrator is left at z = 1 the plant is s / (r delta^n) there.
struct AtRest {
  double s = 0.0;
  double r = 1.0;
};

AtRest at_rest(const FilteredPlant& plant) {
  AtRest result;
  for (const SampledTerm& term : plant.terms) {
    if (term.integrators == 0) continue;
    const auto zeros = static_cast<std::size_t>(term.integrators);
    result.s = term.numerator[0];
    for (const FilterSection& section : plant.filters) result.s *= static_gain(section);
    result.r = zeros < term.degree ? term.denominator[zeros] : 1.0;
  }
  return result;
}

// delta^power; |delta|² = x is left out of every pair of factors: delta²/x = -z.
template <typename Real>
OnCircle<Real> reduced_integrators(int power, const CirclePoint<Real>& point) {
  OnCircle<Real> result{Real(1.0), Real(0.0)};
  const OnCircle<Real> minus_z{0.5 * point.chord_squared + -1.0, Real(-1.0)};
  for (int i = 0; i + 1 < power; i += 2) result = multiply(result, minus_z, point);
  if (power % 2 == 1) result = multiply(result, {-0.5 * point.chord_squared, Real(1.0)}, point);
  return result;
}

}  // namespace

GainLocus::GainLocus(const FilteredPlant& plant, Gain gain, double stiffness, VirtualDamper damper)
    : plant_(plant),
      gain_(gain),
      stiffness_(stiffness),
      damping_(damper.damping),
      c_(damper.velocity_filter_hz > 0.0
             ? -std::expm1(-2.0 * std::numbers::pi * damper.velocity_filter_hz * plant.period)
             : 1.0) {
  for (const SampledTerm& term : plant.terms) integrators_ += term.integrators;
  nyquist_pairs_ = nyquist_zeros(plant) / 2;
  integrators_kept_ = integrators_;
  // The backward difference cancels one pole at z = 1.
  if (gain_ == Gain::damping && integrators_ > 0) integrators_kept_ = integrators_ - 1;
}

// (delta + c) conj(delta) and so on, see the header; integrators cancelled by the damper leave conj(delta) out.
template <typename Real>
OnCircle<Real> GainLocus::extra_factor(const CirclePoint<Real>& point) const {
  const Real& x = point.chord_squared;
  if (gain_ == Gain::damping) {
    if (integrators_ > 0) return {c_ - 0.5 * x, Real(1.0)};
    return {(1.0 - 0.5 * c_) * x, Real(-c_)};
  }
  const double rate = damping_ * c_ / plant_.period;
  return {(stiffness_ * (1.0 - c_) + rate * (1.0 - 0.5 * c_)) * x + stiffness_ * c_ * c_, Real(-rate * c_)};
}

template <typename Real>
Real GainLocus::assemble(const CirclePoint<Real>& point, const OnCircle<Real>& delay) const {
  // Where the damper is closed as well, den is a sum and keeps all its integrators; so does a single one.
  const bool reduce = (integrators_ > 1 && !damper_closed()) || integrators_kept_ < integrators_;
  OnCircle<Real> integrators{Real(1.0), Real(0.0)};
  if (reduce) integrators = reduced_integrators(integrators_kept_, point);
  PlantFraction<Real> plant = plant_fraction(plant_, point, reduce ? &integrators : nullptr, 2 * nyquist_pairs_);
  // Of every pair of the filters' zeros at z = -1, (z + 1)² = z (4 - x), the positive 4 - x is left out.
  const OnCircle<Real> z{1.0 - 0.5 * point.chord_squared, Real(1.0)};
  for (std::size_t i = 0; i < nyquist_pairs_; ++i) plant.numerator = multiply(plant.numerator, z, point);
  OnCircle<Real> product = multiply(plant.denominator, conj(plant.numerator), point);
  if (gain_ != Gain::stiffness) product = multiply(product, extra_factor(point), point);
  const Real phase = plant_.delay_samples == 0 ? product.odd : delay.even * product.odd + delay.odd * product.even;
  if (!damper_closed()) return phase;
  const Real filter = (1.0 - c_) * point.chord_squared + c_ * c_;  // |delta + c|²
  Real seen = squared_magnitude(plant.numerator, point);
  for (std::size_t i = 0; i < nyquist_pairs_; ++i) seen = (4.0 - point.chord_squared) * seen;
  return filter * phase + (damping_ * c_ * c_ / plant_.period) * seen;
}

double GainLocus::value(double angle) const {
  return assemble(circle_point(angle), delay_factor(plant_.delay_samples, angle));
}

template <typename Scalar>
BoundedJet<Scalar> GainLocus::model(double begin, double end) const {
  return assemble(circle_interval<Scalar>(begin, end), delay_factor<Scalar>(plant_.delay_samples, begin, end));
}

template BoundedJet<double> GainLocus::model<double>(double, double) const;
template BoundedJet<Extended> GainLocus::model<Extended>(double, double) const;

// With P = z^-L S/D and positive factors left out, f = -Im[P W] + B Im[v] |P|², W = 1, v or K + B v.
GainLocus::TermSum GainLocus::by_terms(double angle) const {
  constexpr double unit = 16.0 * std::numeric_limits<double>::epsilon();
  const std::complex<double> delta(-0.5 * circle_point(angle).chord_squared, std::sin(angle));
  std::complex<double> plant = 0.0;
  double noise = 0.0;
  double of_terms = 0.0;    // sum of their magnitudes
  double of_factors = 0.0;  // rounding of the denominators, relative
  for (const SampledTerm& term : plant_.terms) {
    const std::complex<double> value = response(term, angle);
    std::complex<double> power = 1.0;
    std::complex<double> denominator = 0.0;
    double size = 0.0;
    for (std::size_t i = 0; i <= term.degree; ++i, power *= delta) {
      const double coefficient = i < term.degree ? term.denominator[i] : 1.0;
      denominator += coefficient * power;
      size += std::abs(coefficient) * std::abs(power);
    }
    plant += value;
    noise += unit * std::abs(value) * (1.0 + size / std::abs(denominator));
    of_terms += std::abs(value);
    of_factors += unit * size / std::abs(denominator);
  }
  if (!plant_.numerator_rest.empty()) {  // the sum added up in double-double: better where the terms cancel
    constexpr double extended_unit = 1e-29;
    const CirclePoint<double> point = circle_point(angle);
    const OnCircle<double> added = sum_of_numerators(plant_, point);
    std::complex<double> quotient(added.even, added.odd * std::sin(angle));
    double size = 0.0;
    double power = 1.0;
    for (const double c : plant_.numerator) {
      size += std::abs(c) * power;
      power *= std::abs(delta);
    }
    const double of_sum = extended_unit * size / std::abs(quotient);
    for (const SampledTerm& term : plant_.terms) {
      const OnCircle<double> denominator = denominator_of(term, 0, point);
      quotient /= std::complex<double>(denominator.even, denominator.odd * std::sin(angle));
    }
    const double lost = std::abs(quotient) * (of_sum + unit + of_factors) + extended_unit * of_terms;
    if (lost < noise) {
      plant = quotient;
      noise = lost;
    }
  }
  const std::complex<double> turned =
      filter_response(plant_, angle) * std::polar(1.0, -static_cast<double>(plant_.delay_samples) * angle);
  plant *= turned;
  noise = noise * std::abs(turned) + unit * std::abs(plant) * (1.0 + static_cast<double>(plant_.delay_samples));
  const std::complex<double> velocity = c_ / plant_.period * delta / (delta + c_);
  if (gain_ == Gain::stiffness) {
    const double damping = damping_ * velocity.imag();
    const double size = std::abs(plant);
    return {-plant.imag() + damping * size * size, noise * (1.0 + 2.0 * damping * size), size};
  }
  const std::complex<double> weight = gain_ == Gain::damping ? velocity : stiffness_ + damping_ * velocity;
  return {-(plant * weight).imag(), noise * std::abs(weight), std::abs(plant * weight)};
}

std::vector<double> GainLocus::pole_angles() const {
  std::vector<double> angles;
  for (const SampledTerm& term : plant_.terms) {
    if (term.degree != 2) continue;
    // delta² + d1 delta + d0
    const double half = -0.5 * term.denominator[1];
    const double square = term.denominator[0] - half * half;
    if (square > 0.0) angles.push_back(std::atan2(std::sqrt(square), 1.0 + half));
  }
  return angles;
}

// v = (c/T) delta / (delta + c)
double GainLocus::velocity_size(double chord_squared) const {
  return c_ / plant_.period * std::sqrt(chord_squared / (c_ * c_ + (1.0 - c_) * chord_squared));
}

double GainLocus::gain(double angle) const {
  // The damper's zero at z = 1 and an integrator cancel: the limit.
  if (angle == 0.0 && gain_ == Gain::damping && integrators_ > 0) {
    if (integrators_kept_ > 0) return 0.0;
    // P v -> s / (r delta) delta/T. In closed form: no angle is small beside every pole of a heavy user.
    const auto [s, r] = at_rest(plant_);
    return -plant_.period * r / s;
  }
  if (angle >= std::numbers::pi && nyquist_zeros(plant_) > 0) return std::numeric_limits<double>::infinity();
  const CirclePoint<double> point = circle_point(angle);
  const auto [numerator, denominator] = plant_fraction(plant_, point);
  const OnCircle<double> product =
      multiply(multiply(denominator, conj(numerator), point), delay_factor(plant_.delay_samples, angle), point);
  // 1/P, real where the phase condition holds without a damper
  OnCircle<double> one_over_plant = scaled(1.0 / squared_magnitude(numerator, point), product);
  if (plant_.at_nyquist && angle >= std::numbers::pi) {
    one_over_plant = {1.0 / (*plant_.at_nyquist * filter_response(plant_, angle).real()), 0.0};
  }
  const double x = point.chord_squared;
  const double filter = c_ * c_ + (1.0 - c_) * x;
  const double rate = c_ / plant_.period;
  const double velocity = rate * x * (1.0 - 0.5 * c_) / filter;  // Re v; Im v / sin = rate c / filter
  if (gain_ == Gain::stiffness) return -one_over_plant.even - damping_ * velocity;
  // kappa = -1 / (P C) = -Re[(1/P) conj C] / |C|², C = v or K + B v
  OnCircle<double> controller{velocity, rate * c_ / filter};
  if (gain_ == Gain::wall) controller = sum(scaled(damping_, controller), {stiffness_, 0.0});
  return -multiply(one_over_plant, conj(controller), point).even / squared_magnitude(controller, point);
}

int GainLocus::initially_unstable(double phase_near_zero) const {
  int unstable = 0;
  for (const SampledTerm& term : plant_.terms) unstable += term.unstable_poles;
  // Of poles that coincide on the circle, half leave it outwards.
  if (begins_at_plant_poles()) {
    for (const SampledTerm& term : plant_.terms) unstable += 2 * (term.undamped_pairs / 2);
  }
  if (integrators_kept_ == 0) return unstable;
  // Near z = 1, delta^n r + kappa s = 0: the poles leave at the angles of (-kappa s / r)^(1/n).
  const int n = damper_closed() ? 1 : integrators_kept_;
  auto [s, r] = at_rest(plant_);
  if (damper_closed()) r = (integrators_ == 1 ? r * c_ : 0.0) + damping_ * c_ / plant_.period * s;
  for (int i = 0; i < n; ++i) {
    const double turn = s * r > 0.0 ? 2.0 * i + 1.0 : 2.0 * i;
    const double cosine = std::cos(std::numbers::pi * turn / n);
    if (cosine > 1e-9 || (cosine > -1e-9 && phase_near_zero < 0.0)) ++unstable;
  }
  return unstable;
}

}  // namespace zwidth::internal
