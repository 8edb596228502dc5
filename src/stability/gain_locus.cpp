#include "stability/gain_locus.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stability/plant_fraction.hpp"

namespace zwidth {
namespace {

// u = sin(L angle) / sin(angle). Angles beyond pi/2 are given by their distance to pi: sin(L pi - y) = -cos(L pi) sin
// y.
double dirichlet_ratio(double samples, double distance, bool from_pi) {
  const double ratio = distance > 0.0 ? std::sin(samples * distance) / std::sin(distance) : samples;
  return from_pi && std::fmod(samples, 2.0) == 0.0 ? -ratio : ratio;
}

OnCircle<double> delay_factor(std::size_t delay_samples, double angle) {
  if (delay_samples == 0) return {1.0, 0.0};
  const auto samples = static_cast<double>(delay_samples);
  const bool from_pi = angle > std::numbers::pi / 2.0;
  return {std::cos(samples * angle), dirichlet_ratio(samples, from_pi ? std::numbers::pi - angle : angle, from_pi)};
}

// z^L at x, by the angle; near z = -1 by the distance to pi.
OnCircle<double> delay_at(std::size_t delay_samples, double x) {
  const auto samples = static_cast<double>(delay_samples);
  const bool from_pi = x > 2.0;
  const double distance = 2.0 * std::asin(0.5 * std::sqrt(from_pi ? 4.0 - x : x));
  const double cosine = std::cos(samples * distance);
  return {from_pi && std::fmod(samples, 2.0) == 1.0 ? -cosine : cosine, dirichlet_ratio(samples, distance, from_pi)};
}

// z^L at x by repeated squaring, in double-double.
OnCircle<Extended> delay_at(std::size_t delay_samples, const Extended& x) {
  const CirclePoint<Extended> point{x, x * (1.0 - 0.25 * x)};
  OnCircle<Extended> power{Extended(1.0), Extended(0.0)};
  OnCircle<Extended> square{1.0 - 0.5 * x, Extended(1.0)};
  for (std::size_t left = delay_samples; left > 0; left /= 2) {
    if (left % 2 == 1) power = multiply(power, square, point);
    square = multiply(square, square, point);
  }
  return power;
}

// Close enough to z = 1 for a limit; the error is its square.
constexpr double cancelled_angle = 1e-7;

template <typename Scalar>
constexpr double rounding_unit = std::numeric_limits<double>::epsilon();
template <>
constexpr double rounding_unit<Extended> = 1e-31;

// z^L on an interval of x, even = T_L(y) and odd = u = U_{L-1}(y) with y = 1 - x/2 = cos(angle):
//   d even/dx = -(L/2) u,   du/dx = (L even - y u) / (2 sin²),
// second derivatives from the Chebyshev equations 4 sin² e'' + 2 y e' + L² e = 0 and 4 sin² u'' + 6 y u' + (L² - 1) u =
// 0, or from their greatest values, at x = 0, whichever bound is smaller.
template <typename Scalar>
OnCircle<BoundedJet<Scalar>> delay_factor(std::size_t delay_samples, double begin, double end) {
  using Jet = BoundedJet<Scalar>;
  if (delay_samples == 0) return {Jet(1.0), Jet(0.0)};
  const auto samples = static_cast<double>(delay_samples);
  const CirclePoint<Jet> interval = circle_interval<Scalar>(begin, end);
  const double h = 0.5 * (end - begin);
  const Scalar y = 1.0 - 0.5 * interval.chord_squared.value;
  const Scalar sine_squared = interval.sine_squared.value;
  const OnCircle<Scalar> centre = delay_at(delay_samples, interval.chord_squared.value);
  const Scalar odd_slope = (samples * centre.even - y * centre.odd) / (2.0 * sine_squared);
  const double slope_error = rounding_unit<Scalar> * 8.0 * samples / leading(sine_squared);

  const double squared = samples * samples;
  double even_bend = squared * (squared - 1.0) / 12.0;
  double odd_bend = std::max((squared - 4.0) * (squared - 1.0) * samples / 60.0, 0.0);
  double odd_size = samples;
  const double least_sine_squared = std::min(begin * (1.0 - 0.25 * begin), end * (1.0 - 0.25 * end));
  if (least_sine_squared > 0.0) {
    odd_size = std::min(samples, 1.0 / std::sqrt(least_sine_squared));
    const double odd_slope_size =
        std::min((samples + odd_size) / (2.0 * least_sine_squared), samples * (squared - 1.0) / 6.0);
    even_bend = std::min(even_bend, (samples * odd_size + squared) / (4.0 * least_sine_squared));
    odd_bend = std::min(odd_bend, (6.0 * odd_slope_size + (squared - 1.0) * odd_size) / (4.0 * least_sine_squared));
  }
  const double rounding = 1.0 + samples / 16.0;  // of z^L
  return {{centre.even, (-0.5 * samples * h) * centre.odd, even_bend * h * h, rounding},
          {centre.odd, odd_slope * h, odd_bend * h * h + 2.0 * slope_error * h, odd_size * rounding}};
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

template <typename Scalar>
BoundedJet<Scalar> GainLocus::model(double begin, double end) const {
  return assemble(circle_interval<Scalar>(begin, end), delay_factor<Scalar>(plant_.delay_samples, begin, end));
}

template BoundedJet<double> GainLocus::model<double>(double, double) const;
template BoundedJet<Extended> GainLocus::model<Extended>(double, double) const;

double GainLocus::gain(double angle) const {
  // The damper's zero at z = 1 and an integrator cancel: the limit.
  if (angle == 0.0 && gain_ == Gain::damping && integrators_ > 0) {
    if (integrators_kept_ > 0) return 0.0;
    angle = cancelled_angle;
  }
  const CirclePoint<double> point = circle_point(angle);
  const auto [numerator, denominator] = plant_fraction(plant_, point);
  const OnCircle<double> product =
      multiply(multiply(denominator, conj(numerator), point), delay_factor(plant_.delay_samples, angle), point);
  // 1/P, real where the phase condition holds without a damper
  OnCircle<double> one_over_plant = scaled(1.0 / squared_magnitude(numerator, point), product);
  if (plant_.at_nyquist && angle >= std::numbers::pi) one_over_plant = {1.0 / *plant_.at_nyquist, 0.0};
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
  for (const SampledTerm& term : plant_.terms) unstable += 2 * (term.undamped_pairs / 2);
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
