#include "design/sensitivities/controller_sensitivity.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "zwidth/sampling/filter_section.hpp"

namespace zwidth::internal {
namespace {

using Complex = std::complex<double>;
using Kind = DesignParameter::Kind;
using std::numbers::pi;

/// Coefficients of 1, s, s².
using Coefficients = std::array<double, 3>;

Coefficients ascending(const std::vector<double>& descending) {
  Coefficients result{};
  for (std::size_t i = 0; i < descending.size(); ++i) result[i] = descending[descending.size() - 1 - i];
  return result;
}

/// One filter: value and logarithmic slopes.
struct Section {
  Complex value;
  Complex by_angle;
  Complex by_frequency;  // per Hz
  Complex by_damping_ratio;
  Complex by_depth;
  Complex by_ratio;
  Complex by_period;
};

/// A polynomial sum c_i y^i x^(degree - i) and its slopes.
struct Polynomial {
  Complex value;
  Complex by_y;
  Complex by_x;
};

Polynomial homogeneous(const Coefficients& c, std::size_t degree, Complex y, double x) {
  if (degree == 1) return {c[0] * x + c[1] * y, c[1], c[0]};
  return {c[0] * x * x + (c[1] * x + c[2] * y) * y, c[1] * x + 2.0 * c[2] * y, 2.0 * c[0] * x + c[1] * y};
}

/// F = N/D in u = s/w; where nothing is prewarped w is 1 rad/s and tan(w T/2) is T/2.
Section of_polynomials(const Coefficients& numerator, const Coefficients& denominator, std::size_t degree,
                       double frequency_hz, double period, double angle) {
  const double w = frequency_hz > 0.0 ? 2.0 * pi * frequency_hz : 1.0;
  const double warp = frequency_hz > 0.0 ? std::tan(0.5 * w * period) : 0.5 * period;
  const double sine = std::sin(0.5 * angle);
  const double cosine = angle >= pi ? 0.0 : std::cos(0.5 * angle);
  const Complex y(0.0, sine / warp);
  const Polynomial n = homogeneous(numerator, degree, y, cosine);
  const Polynomial d = homogeneous(denominator, degree, y, cosine);
  const Complex by_y = n.by_y / n.value - d.by_y / d.value;
  const Complex by_x = n.by_x / n.value - d.by_x / d.value;
  const Complex by_warp = -by_y * y / warp;
  Section section;
  section.value = n.value / d.value;
  section.by_angle = by_y * Complex(0.0, 0.5 * cosine / warp) - 0.5 * sine * by_x;
  const double growth = 0.5 * (1.0 + warp * warp);  // of the tangent by w T
  section.by_period = by_warp * (frequency_hz > 0.0 ? w * growth : 0.5);
  if (frequency_hz > 0.0) section.by_frequency = by_warp * (period * growth) * (2.0 * pi);
  const auto by_coefficients = [&](const Coefficients& of_numerator, const Coefficients& of_denominator) {
    return homogeneous(of_numerator, degree, y, cosine).value / n.value -
           homogeneous(of_denominator, degree, y, cosine).value / d.value;
  };
  section.by_damping_ratio = by_coefficients({0.0, 0.0, 0.0}, {0.0, 2.0, 0.0});
  return section;
}

Section of_biquad(const WallFilter& filter, double period, double angle) {
  Coefficients numerator = ascending(filter.numerator);
  Coefficients denominator = ascending(filter.denominator);
  const std::size_t degree = filter.denominator.size() - 1;
  if (filter.frequency_hz == 0.0) return of_polynomials(numerator, denominator, degree, 0.0, period, angle);
  // In u = s/w the coefficients are c_i w^i, and move with w.
  const double w = 2.0 * pi * filter.frequency_hz;
  Coefficients numerator_slope{};
  Coefficients denominator_slope{};
  double power = 1.0;
  for (std::size_t i = 0; i < numerator.size(); ++i, power *= w) {
    numerator[i] *= power;
    denominator[i] *= power;
    numerator_slope[i] = static_cast<double>(i) * numerator[i] / w;
    denominator_slope[i] = static_cast<double>(i) * denominator[i] / w;
  }
  Section section = of_polynomials(numerator, denominator, degree, filter.frequency_hz, period, angle);
  const double cosine = angle >= pi ? 0.0 : std::cos(0.5 * angle);
  const Complex y(0.0, std::sin(0.5 * angle) / std::tan(0.5 * w * period));
  section.by_frequency +=
      2.0 * pi *
      (homogeneous(numerator_slope, degree, y, cosine).value / homogeneous(numerator, degree, y, cosine).value -
       homogeneous(denominator_slope, degree, y, cosine).value / homogeneous(denominator, degree, y, cosine).value);
  return section;
}

Section of_digital(const WallFilter& filter, double angle) {
  const Coefficients numerator = ascending(filter.numerator);
  const Coefficients denominator = ascending(filter.denominator);
  const Complex z = std::polar(1.0, angle);
  const auto at = [z](const Coefficients& c) { return c[0] + (c[1] + c[2] * z) * z; };
  const auto turned = [z](const Coefficients& c) { return (c[1] + 2.0 * c[2] * z) * z; };  // z d/dz
  Section section;
  section.value = at(numerator) / at(denominator);
  section.by_angle = Complex(0.0, 1.0) * (turned(numerator) / at(numerator) - turned(denominator) / at(denominator));
  return section;
}

Section section_of(const WallFilter& filter, double period, double angle) {
  using enum WallFilter::Kind;
  const double twice = 2.0 * filter.damping_ratio;
  const auto with = [&](const Coefficients& numerator, const Coefficients& denominator, std::size_t degree) {
    return of_polynomials(numerator, denominator, degree, filter.frequency_hz, period, angle);
  };
  // d log F / d c_1 of a numerator and a denominator with y x and y in their places
  switch (filter.kind) {
    case low_pass:
      return filter.order == 1 ? with({1.0}, {1.0, 1.0}, 1) : with({1.0}, {1.0, twice, 1.0}, 2);
    case notch: {
      const Coefficients numerator{1.0, filter.depth * twice, 1.0};
      const Coefficients denominator{1.0, twice, 1.0};
      Section section = with(numerator, denominator, 2);
      const double cosine = angle >= pi ? 0.0 : std::cos(0.5 * angle);
      const Complex y(0.0, std::sin(0.5 * angle) / std::tan(pi * filter.frequency_hz * period));
      const Complex share = 2.0 * y * cosine / homogeneous(numerator, 2, y, cosine).value;
      section.by_damping_ratio += filter.depth * share;
      section.by_depth = filter.damping_ratio * share;
      return section;
    }
    case lead_lag: {
      const double root = std::sqrt(filter.ratio);
      Section section = with({1.0, root}, {1.0, 1.0 / root}, 1);
      const double cosine = angle >= pi ? 0.0 : std::cos(0.5 * angle);
      const Complex y(0.0, std::sin(0.5 * angle) / std::tan(pi * filter.frequency_hz * period));
      section.by_ratio = 0.5 / root * y / (cosine + root * y) + 0.5 / (root * filter.ratio) * y / (cosine + y / root);
      return section;
    }
    case biquad:
      return of_biquad(filter, period, angle);
    case digital:
      break;
  }
  return of_digital(filter, angle);
}

Complex slope_of(const Section& section, Kind kind) {
  switch (kind) {
    case Kind::filter_frequency_hz:
      return section.by_frequency;
    case Kind::filter_damping_ratio:
      return section.by_damping_ratio;
    case Kind::filter_depth:
      return section.by_depth;
    case Kind::filter_ratio:
      return section.by_ratio;
    default:
      return 0.0;
  }
}

}  // namespace

FilterSensitivity filter_sensitivity(const Device& device, double angle, std::span<const DesignParameter> parameters) {
  FilterSensitivity sensitivity;
  sensitivity.log_by_parameter.assign(parameters.size(), 0.0);
  const std::vector<WallFilter>& filters = device.parameters().wall.filters;
  for (std::size_t f = 0; f < filters.size(); ++f) {
    const Section section = section_of(filters[f], device.loop().sampling_period, angle);
    sensitivity.value *= section.value;
    sensitivity.log_by_angle += section.by_angle;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      if (parameters[i].kind == Kind::sampling_period) {
        sensitivity.log_by_parameter[i] += section.by_period;
      } else if (parameters[i].index == f) {
        sensitivity.log_by_parameter[i] += slope_of(section, parameters[i].kind);
      }
    }
  }
  return sensitivity;
}

DamperSensitivity damper_sensitivity(const Device& device, double angle, std::span<const DesignParameter> parameters) {
  const double period = device.loop().sampling_period;
  const double damping = device.parameters().wall.damping;
  const double corner = device.parameters().wall.velocity_filter_hz;
  const double decay = velocity_filter_pole(corner, period);  // a
  const double share = velocity_filter_gain(corner, period);  // 1 - a
  const double half = std::sin(0.5 * angle);
  const std::complex<double> difference(2.0 * half * half, angle >= pi ? 0.0 : std::sin(angle));  // 1 - z^-1
  const std::complex<double> denominator = share + decay * difference;                            // 1 - a z^-1
  const std::complex<double> velocity = share / period * difference / denominator;                // v
  const std::complex<double> turned = std::complex<double>(0.0, 1.0) * (1.0 - difference);        // d(1 - z^-1)/d angle
  const std::complex<double> by_decay = -difference * difference / (period * denominator * denominator);
  DamperSensitivity sensitivity;
  sensitivity.value = damping * velocity;
  sensitivity.by_angle = damping * share / period * turned * share / (denominator * denominator);
  sensitivity.by_parameter.assign(parameters.size(), 0.0);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].kind == Kind::wall_damping) sensitivity.by_parameter[i] = velocity;
    if (parameters[i].kind == Kind::velocity_filter_hz) {
      sensitivity.by_parameter[i] = damping * by_decay * (-2.0 * pi * period * decay);
    }
    if (parameters[i].kind == Kind::sampling_period) {
      sensitivity.by_parameter[i] = damping * (-velocity / period + by_decay * (-2.0 * pi * corner * decay));
    }
  }
  return sensitivity;
}

}  // namespace zwidth::internal
