#include "design/region/wall_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <optional>

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;

constexpr int even_angles = 24;
constexpr int low_angles = 24;
constexpr double lowest_angle = 1e-4;
constexpr double greatest_loop_gain = 1e6;  // beyond, a bound of |w| is not worth having
constexpr int bisections = 60;

// A polynomial in delta and its logarithmic derivative with respect to z.
struct Factor {
  Complex value;
  Complex log_slope;
};

// c[0] + c[1] delta + ... + c[count] delta^count, c[count] = leading
Factor polynomial_at(const double* c, std::size_t count, double leading, Complex delta) {
  Complex value = leading;
  Complex slope = 0.0;
  for (std::size_t i = count; i-- > 0;) {
    slope = slope * delta + value;
    value = value * delta + c[i];
  }
  return {value, slope / value};
}

// The open loop z^L D (z - a) and P at z = e^{j angle}.
struct OpenLoop {
  double degree = 0.0;     // N
  double magnitude = 1.0;  // |D (z - a)|
  double turn = 0.0;       // d arg/dt of all of it
  double plant = 0.0;      // |P|
  Complex plant_slope;     // d ln P/dt
  Complex velocity_slope;  // d ln v/dt
};

OpenLoop open_loop(const BoundaryCurve& curve, double angle) {
  const double half = std::sin(0.5 * angle);
  const Complex delta(-2.0 * half * half, std::sin(angle));
  const Complex z = 1.0 + delta;
  const Complex jz = Complex(0.0, 1.0) * z;
  const double c = curve.filter();
  const FilteredPlant& plant = curve.added_up();
  const auto delay = static_cast<double>(plant.delay_samples);
  OpenLoop open;
  open.degree = delay + 1.0;
  open.magnitude = std::abs(delta + c);
  open.turn = delay + (z / (delta + c)).real();
  Complex slope = 0.0;  // of S/D
  double plant_magnitude = 1.0;
  for (const SampledTerm& term : plant.terms) {
    const Factor d = polynomial_at(term.denominator, term.degree, 1.0, delta);
    open.degree += static_cast<double>(term.degree);
    open.magnitude *= std::abs(d.value);
    open.turn += (z * d.log_slope).real();
    slope -= d.log_slope;
    plant_magnitude /= std::abs(d.value);
  }
  const SampledTerm& first = plant.terms.front();
  const Factor s =
      plant.numerator.empty()
          ? polynomial_at(first.numerator, first.degree, first.numerator[first.degree], delta)
          : polynomial_at(plant.numerator.data(), plant.numerator.size() - 1, plant.numerator.back(), delta);
  slope += s.log_slope;
  plant_magnitude *= std::abs(s.value);
  for (const FilterSection& section : plant.filters) {
    const Factor d = polynomial_at(section.denominator.data(), section.degree, 1.0, delta);
    const std::size_t zeros = section.nyquist_zeros;
    const std::size_t degree = section.degree - zeros;
    const Factor n = polynomial_at(section.numerator.data(), degree, section.numerator[degree], delta);
    open.degree += static_cast<double>(section.degree);
    open.magnitude *= std::abs(d.value);
    open.turn += (z * d.log_slope).real();
    slope += n.log_slope - d.log_slope + static_cast<double>(zeros) / (delta + 2.0);
    plant_magnitude *= std::abs(n.value / d.value) * std::pow(std::abs(delta + 2.0), static_cast<double>(zeros));
  }
  open.plant = plant_magnitude;
  open.plant_slope = jz * slope - Complex(0.0, delay);
  open.velocity_slope = jz * (1.0 / delta - 1.0 / (delta + c));
  return open;
}

// The largest |w| at which arg c can still turn by N/2. With d ln w/dt = lambda + j phi and |w| >= r > 1,
// w/(1 + w) lies in a disc about r²/(r² - 1) of radius r/(r² - 1), so that
//
//     d arg(1 + w)/dt = Im[(lambda + j phi) w/(1 + w)] <= phi r/(r + 1) + |lambda| r/(r² - 1)   for phi < 0;
//
// d ln(K + B v)/dt is at most |d ln v/dt|, as |K + B v| >= B |v|.
std::optional<double> loop_gain_by_turn(const OpenLoop& open) {
  const double controller = std::abs(open.velocity_slope);
  const double phi = open.plant_slope.imag() + controller;
  const double lambda = std::abs(open.plant_slope.real()) + controller;
  const double needed = 0.5 * open.degree - open.turn;
  if (!(phi < 0.0)) return std::nullopt;
  const auto turns_too_slowly = [&](double r) {
    return phi * r / (r + 1.0) + lambda * r / ((r - 1.0) * (r + 1.0)) < needed;
  };
  if (!turns_too_slowly(greatest_loop_gain)) return std::nullopt;
  double low = 1.0;
  double high = greatest_loop_gain;
  for (int i = 0; i < bisections; ++i) {
    const double middle = std::sqrt(low * high);
    (turns_too_slowly(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace

CurveBounds wall_bounds(const BoundaryCurve& curve) {
  CurveBounds bounds{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const auto add = [&bounds](double largest_wall, double velocity) {
    if (!std::isfinite(largest_wall)) return;
    bounds.stiffness = std::min(bounds.stiffness, largest_wall);
    bounds.damping = std::min(bounds.damping, largest_wall / velocity);
  };
  const double velocity_at_nyquist = curve.velocity_at_nyquist();
  // Sampled poles e^{sT} < 0 come in pairs: the open loop is on the stable side of the line.
  const double nyquist = curve.nyquist_stiffness();
  if (nyquist > 0.0) add(nyquist, velocity_at_nyquist);
  const auto look_at = [&](double angle) {
    const OpenLoop open = open_loop(curve, angle);
    double loop_gain = std::exp2(open.degree) / open.magnitude + 1.0;
    if (const auto by_turn = loop_gain_by_turn(open)) loop_gain = std::min(loop_gain, *by_turn);
    add(loop_gain / open.plant, std::abs(curve.velocity(angle)));
  };
  const double first_even = std::numbers::pi / even_angles;
  for (int i = 1; i <= even_angles; ++i) look_at(first_even * i);
  for (int i = 0; i < low_angles; ++i) {
    look_at(lowest_angle * std::pow(first_even / lowest_angle, static_cast<double>(i) / low_angles));
  }
  return bounds;
}

}  // namespace zwidth::internal
