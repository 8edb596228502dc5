#include "stability/gain_locus.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stability/plant_fraction.hpp"

namespace zwidth {
namespace {

// sin(L angle) / sin(angle) and its derivative; angles beyond pi/2 are reflected to keep digits near pi.
struct DirichletRatio {
  double value;
  double derivative;
  double derivative_error;
};

DirichletRatio dirichlet_ratio(double samples, double angle) {
  const bool reflected = angle > std::numbers::pi / 2.0;
  const double near = reflected ? std::numbers::pi - angle : angle;
  if (near <= 0.0) {
    const double limit = reflected && std::fmod(samples, 2.0) == 0.0 ? -samples : samples;
    return {limit, 0.0, 0.0};
  }
  const double sine = std::sin(near);
  const double ratio = std::sin(samples * near) / sine;
  const double slope = (samples * std::cos(samples * near) - ratio * std::cos(near)) / sine;
  const double error = 1e-15 * samples / sine;
  if (!reflected) return {ratio, slope, error};
  const double sign = std::fmod(samples, 2.0) == 0.0 ? -1.0 : 1.0;  // sin(L pi - y) = -cos(L pi) sin y
  return {sign * ratio, -sign * slope, error};
}

OnCircle<double> delay_factor(std::size_t delay_samples, double angle) {
  if (delay_samples == 0) return {1.0, 0.0};
  const auto samples = static_cast<double>(delay_samples);
  return {std::cos(samples * angle), dirichlet_ratio(samples, angle).value};
}

// z^L on [centre - h, centre + h].
OnCircle<BoundedJet> delay_factor(std::size_t delay_samples, double begin, double end) {
  if (delay_samples == 0) return {BoundedJet(1.0), BoundedJet(0.0)};
  const auto samples = static_cast<double>(delay_samples);
  const double centre = 0.5 * (begin + end);
  const double h = 0.5 * (end - begin);
  const double reach = samples * h;
  const double rounding = 1.0 + samples / 16.0;  // of L angle, the argument of sin and cos
  const BoundedJet even(std::cos(samples * centre), -reach * std::sin(samples * centre), reach * reach, rounding);
  const DirichletRatio ratio = dirichlet_ratio(samples, centre);
  // |u''| from u = sum of L cosines, or from u = sin(L t)/sin t away from its zeros, whichever is smaller.
  double second = samples * (samples * samples - 1.0) / 3.0;
  double size = samples;
  const double sine = std::min(std::sin(begin), std::sin(end));
  if (sine > 0.0) {
    const double u = std::min(samples, 1.0 / sine);
    const double first = (samples + u) / sine;
    second = std::min(second, (samples * samples + 2.0 * first + u) / sine);
    size = u;
  }
  return {even,
          {ratio.value, ratio.derivative * h, second * h * h + 2.0 * ratio.derivative_error * h, size * rounding}};
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

GainLocus::GainLocus(const SampledPlant& plant, Gain gain, double stiffness, VirtualDamper damper)
    : plant_(plant),
      gain_(gain),
      stiffness_(stiffness),
      damping_(damper.damping),
      c_(damper.velocity_filter_hz > 0.0
             ? -std::expm1(-2.0 * std::numbers::pi * damper.velocity_filter_hz * plant.period)
             : 1.0) {
  for (const SampledTerm& term : plant.terms) integrators_ += term.integrators;
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
  const PlantFraction<Real> plant = plant_fraction(plant_, point, reduce ? &integrators : nullptr);
  OnCircle<Real> product = multiply(plant.denominator, conj(plant.numerator), point);
  if (gain_ != Gain::stiffness) product = multiply(product, extra_factor(point), point);
  const Real phase = plant_.delay_samples == 0 ? product.odd : delay.even * product.odd + delay.odd * product.even;
  if (!damper_closed()) return phase;
  const Real filter = (1.0 - c_) * point.chord_squared + c_ * c_;  // |delta + c|²
  return filter * phase + (damping_ * c_ * c_ / plant_.period) * squared_magnitude(plant.numerator, point);
}

double GainLocus::value(double angle) const {
  return assemble(circle_point(angle), delay_factor(plant_.delay_samples, angle));
}

BoundedJet GainLocus::model(double begin, double end) const {
  return assemble(circle_interval(begin, end), delay_factor(plant_.delay_samples, begin, end));
}

double GainLocus::gain(double angle) const {
  const CirclePoint<double> point = circle_point(angle);
  const auto [numerator, denominator] = plant_fraction(plant_, point);
  const OnCircle<double> product =
      multiply(multiply(denominator, conj(numerator), point), delay_factor(plant_.delay_samples, angle), point);
  const double inverse_plant =
      product.even / squared_magnitude(numerator, point);  // Re 1/P where Im is zero, or B v = 0
  const double x = point.chord_squared;
  const double filter = c_ * c_ + (1.0 - c_) * x;
  const double rate = c_ / plant_.period;
  const double velocity = rate * x * (1.0 - 0.5 * c_) / filter;  // Re v; Im v / sin = rate c / filter
  if (gain_ == Gain::stiffness) return -inverse_plant - damping_ * velocity;
  // kappa = -1 / (P C) = -Re[(1/P) conj C] / |C|², C = v or K + B v
  const OnCircle<double> one_over_plant = scaled(1.0 / squared_magnitude(numerator, point), product);
  OnCircle<double> controller{velocity, rate * c_ / filter};
  if (gain_ == Gain::wall) controller = sum(scaled(damping_, controller), {stiffness_, 0.0});
  return -multiply(one_over_plant, conj(controller), point).even / squared_magnitude(controller, point);
}

int GainLocus::initially_unstable(double phase_near_zero) const {
  int unstable = 0;
  for (const SampledTerm& term : plant_.terms) unstable += term.unstable_poles;
  if (integrators_kept_ == 0) return unstable;
  // Near z = 1, delta^n r + kappa s = 0: the poles leave at the angles of (-kappa s / r)^(1/n).
  const int n = damper_closed() ? 1 : integrators_kept_;
  double s = 0.0;
  double r = 1.0;
  for (const SampledTerm& term : plant_.terms) {
    if (term.integrators == 0) continue;
    const auto zeros = static_cast<std::size_t>(term.integrators);
    s = term.numerator[0];
    r = zeros < term.degree ? term.denominator[zeros] : 1.0;
    if (damper_closed()) r = (zeros == 1 ? r * c_ : 0.0) + damping_ * c_ / plant_.period * s;
  }
  for (int i = 0; i < n; ++i) {
    const double turn = s * r > 0.0 ? 2.0 * i + 1.0 : 2.0 * i;
    const double cosine = std::cos(std::numbers::pi * turn / n);
    if (cosine > 1e-9 || (cosine > -1e-9 && phase_near_zero < 0.0)) ++unstable;
  }
  return unstable;
}

}  // namespace zwidth
