#include "stability/loop/delay_factor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "stability/loop/plant_fraction.hpp"

namespace zwidth::internal {
namespace {

// u = sin(L angle) / sin(angle). Angles beyond pi/2 are given by their distance to pi: sin(L pi - y) = -cos(L pi) sin
// y.
double dirichlet_ratio(double samples, double distance, bool from_pi) {
  const double ratio = distance > 0.0 ? std::sin(samples * distance) / std::sin(distance) : samples;
  return from_pi && std::fmod(samples, 2.0) == 0.0 ? -ratio : ratio;
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

template <typename Scalar>
constexpr double rounding_unit = std::numeric_limits<double>::epsilon();
template <>
constexpr double rounding_unit<Extended> = 1e-31;

}  // namespace

OnCircle<double> delay_factor(std::size_t delay_samples, double angle) {
  if (delay_samples == 0) return {1.0, 0.0};
  const auto samples = static_cast<double>(delay_samples);
  const bool from_pi = angle > std::numbers::pi / 2.0;
  return {std::cos(samples * angle), dirichlet_ratio(samples, from_pi ? std::numbers::pi - angle : angle, from_pi)};
}

OnCircle<Extended> delay_factor(std::size_t delay_samples, const Extended& x) { return delay_at(delay_samples, x); }

// even = T_L(y) and odd = u = U_{L-1}(y) with y = 1 - x/2 = cos(angle):
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

template OnCircle<BoundedJet<double>> delay_factor<double>(std::size_t, double, double);
template OnCircle<BoundedJet<Extended>> delay_factor<Extended>(std::size_t, double, double);

}  // namespace zwidth::internal
