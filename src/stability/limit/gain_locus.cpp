#include "stability/limit/gain_locus.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stability/loop/delay_factor.hpp"
#include "stability/loop/plant_fraction.hpp"

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
      c_(velocity_filter_gain(damper.velocity_filter_hz, plant.period)) {
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

namespace {

// sum |c_i| |delta|^i
double size_of(const double* c, std::size_t count, double delta) {
  double size = 0.0;
  for (std::size_t i = count; i-- > 0;) size = size * delta + std::abs(c[i]);
  return size;
}

// Rounding of the filters' product, relative, in units.
double rounding_of_filters(const FilteredPlant& plant, double angle, double delta) {
  double rounding = 0.0;
  for (const FilterSection& section : plant.filters) {
    const std::complex<double> d(-0.5 * delta * delta, std::sin(angle));
    const auto& n = section.numerator;
    const auto& c = section.denominator;
    const std::complex<double> above = (n[2] * d + n[1]) * d + n[0];
    const std::complex<double> below = section.degree == 1 ? d + c[0] : (d + c[1]) * d + c[0];
    const double leading = section.degree == 1 ? delta : delta * delta;
    rounding += size_of(n.data(), n.size(), delta) / std::abs(above) +
                (size_of(c.data(), section.degree, delta) + leading) / std::abs(below);
  }
  return rounding;
}

}  // namespace

// With P = z^-L S/D and positive factors left out, f = -Im[P W] + B Im[v] |P|², W = 1, v or K + B v.
GainLocus::TermSum GainLocus::by_terms(double angle) const {
  constexpr double coefficient_unit = std::numeric_limits<double>::epsilon();
  constexpr double unit = 16.0 * coefficient_unit;
  const CirclePoint<double> point = circle_point(angle);
  const std::complex<double> delta(-0.5 * point.chord_squared, std::sin(angle));
  const double delta_size = std::sqrt(point.chord_squared);
  std::complex<double> plant = 0.0;
  double noise = 0.0;
  double of_terms = 0.0;    // sum of their magnitudes
  double of_factors = 0.0;  // rounding of the denominators, relative
  for (const SampledTerm& term : plant_.terms) {
    const OnCircle<double> below = denominator_of(term, 0, point);
    const OnCircle<double> above = numerator_of(term, point);
    const double below_squared = squared_magnitude(below, point);
    const double below_size = std::sqrt(below_squared);
    const OnCircle<double> product = multiply(above, conj(below), point);
    const std::complex<double> value(product.even / below_squared, product.odd * delta.imag() / below_squared);
    const double value_size = std::abs(value);
    double leading = 1.0;
    for (std::size_t i = 0; i < term.degree; ++i) leading *= delta_size;
    const double of_denominator = unit * (size_of(term.denominator, term.degree, delta_size) + leading) / below_size;
    plant += value;
    noise += (unit + of_denominator) * value_size +
             coefficient_unit * size_of(term.numerator, term.degree + 1, delta_size) / below_size;
    of_terms += value_size;
    of_factors += of_denominator;
  }
  const double cancellation = of_terms / std::abs(plant);
  if (plant_.at_nyquist && angle >= std::numbers::pi) {
    plant = plant_.delay_samples % 2 == 0 ? *plant_.at_nyquist : -*plant_.at_nyquist;
    noise = unit * std::abs(plant);
  } else if (!plant_.numerator_rest.empty()) {  // the sum added up in double-double: better where the terms cancel
    constexpr double extended_unit = 1e-29;
    const OnCircle<double> added = sum_of_numerators(plant_, point);
    std::complex<double> quotient(added.even, added.odd * delta.imag());
    const double of_sum =
        extended_unit * size_of(plant_.numerator.data(), plant_.numerator.size(), delta_size) / std::abs(quotient);
    for (const SampledTerm& term : plant_.terms) {
      const OnCircle<double> denominator = denominator_of(term, 0, point);
      quotient /= std::complex<double>(denominator.even, denominator.odd * delta.imag());
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
  noise = noise * std::abs(turned) +
          unit * std::abs(plant) *
              (1.0 + static_cast<double>(plant_.delay_samples) + rounding_of_filters(plant_, angle, delta_size));
  const std::complex<double> velocity = c_ / plant_.period * delta / (delta + c_);
  if (gain_ == Gain::stiffness) {
    const double damping = damping_ * velocity.imag();
    const double size = std::abs(plant);
    return {-plant.imag() + damping * size * size, noise * (1.0 + 2.0 * damping * size), size, cancellation};
  }
  const std::complex<double> weight = gain_ == Gain::damping ? velocity : stiffness_ + damping_ * velocity;
  return {-(plant * weight).imag(), noise * std::abs(weight), std::abs(plant * weight), cancellation};
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
  return gain_of(one_over_plant, point);
}

template <typename Real>
Real GainLocus::gain_of(const OnCircle<Real>& one_over_plant, const CirclePoint<Real>& point) const {
  const Real& x = point.chord_squared;
  const Real filter = c_ * c_ + (1.0 - c_) * x;
  const double rate = c_ / plant_.period;
  const Real velocity = rate * x * (1.0 - 0.5 * c_) / filter;  // Re v; Im v / sin = rate c / filter
  if (gain_ == Gain::stiffness) return Real(0.0) - one_over_plant.even - damping_ * velocity;
  // kappa = -1 / (P C) = -Re[(1/P) conj C] / |C|², C = v or K + B v
  OnCircle<Real> controller{velocity, rate * c_ / filter};
  if (gain_ == Gain::wall) {
    controller = {damping_ * controller.even + stiffness_, damping_ * controller.odd};
  }
  return Real(0.0) - multiply(one_over_plant, conj(controller), point).even / squared_magnitude(controller, point);
}

std::optional<GainLocus::Root> GainLocus::polished_root(double angle) const {
  constexpr int most_widenings = 16;
  constexpr int most_steps = 60;
  constexpr double close_enough = 1e-28;  // relative
  const auto point_of = [](const Extended& x) { return CirclePoint<Extended>{x, x * (1.0 - 0.25 * x)}; };
  const auto f = [&](const Extended& x) { return assemble(point_of(x), delay_factor(plant_.delay_samples, x)); };
  const double start = circle_point(angle).chord_squared;
  Extended low(start);
  Extended high(start);
  Extended at_low(0.0);
  Extended at_high(0.0);
  double width = std::numeric_limits<double>::epsilon() * start;
  int widenings = 0;
  do {
    if (widenings++ == most_widenings || start + width >= 4.0) return std::nullopt;
    low = Extended(start) - width;
    high = Extended(start) + width;
    at_low = f(low);
    at_high = f(high);
    width *= 2.0;
  } while ((leading(at_low) > 0.0) == (leading(at_high) > 0.0));
  Extended x = low;
  for (int i = 0; i < most_steps; ++i) {  // the Illinois method
    const Extended next = (low * at_high - high * at_low) / (at_high - at_low);
    const bool is_done = std::abs(leading(next - x)) <= close_enough * start;
    x = next;
    const Extended at = f(x);
    if (is_done || leading(at) == 0.0) break;
    if ((leading(at) > 0.0) == (leading(at_high) > 0.0)) {
      high = x;
      at_high = at;
      at_low = 0.5 * at_low;
    } else {
      low = x;
      at_low = at;
      at_high = 0.5 * at_high;
    }
  }
  const CirclePoint<Extended> point = point_of(x);
  const auto [numerator, denominator] = plant_fraction(plant_, point);
  OnCircle<Extended> one_over_plant =
      multiply(multiply(denominator, conj(numerator), point), delay_factor(plant_.delay_samples, x), point);
  const Extended seen = squared_magnitude(numerator, point);
  one_over_plant = {one_over_plant.even / seen, one_over_plant.odd / seen};
  return Root{angle_of(leading(x)), leading(gain_of(one_over_plant, point))};
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
