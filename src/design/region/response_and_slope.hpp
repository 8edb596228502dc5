#pragma once

#include <cmath>
#include <complex>

#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::internal {

// z = e^{j angle} by half its angle: two of them turn on by one product, and z - 1 keeps its digits.
struct HalfTurn {
  double cosine = 1.0;
  double sine = 0.0;

  HalfTurn() = default;
  explicit HalfTurn(double half_angle) : cosine(std::cos(half_angle)), sine(std::sin(half_angle)) {}

  [[nodiscard]] HalfTurn turned_by(const HalfTurn& other) const {
    HalfTurn result;
    result.cosine = cosine * other.cosine - sine * other.sine;
    result.sine = sine * other.cosine + cosine * other.sine;
    return result;
  }
  // z - 1
  [[nodiscard]] std::complex<double> delta() const { return {-2.0 * sine * sine, 2.0 * sine * cosine}; }
  // 1/z
  [[nodiscard]] std::complex<double> back() const { return {1.0 - 2.0 * sine * sine, -2.0 * sine * cosine}; }
  // 1 - 1/z
  [[nodiscard]] std::complex<double> one_minus_back() const { return {2.0 * sine * sine, 2.0 * sine * cosine}; }
};

// A function of z = e^{j angle}, and its slope over the angle.
struct ResponseAndSlope {
  std::complex<double> value;
  std::complex<double> slope;
};

// Quotient without a guard against overflow, which is not near.
inline std::complex<double> quotient(std::complex<double> a, std::complex<double> b) {
  const double scale = 1.0 / (b.real() * b.real() + b.imag() * b.imag());
  return {(a.real() * b.real() + a.imag() * b.imag()) * scale, (a.imag() * b.real() - a.real() * b.imag()) * scale};
}

// P on the whole circle, 0 < angle < 2 pi, to the digits of response().
[[nodiscard]] ResponseAndSlope response_and_slope(const SampledPlant& plant, const HalfTurn& turn);

// The velocity filter (1 - a)/T (1 - 1/z)/(1 - a/z).
[[nodiscard]] ResponseAndSlope velocity_and_slope(double filter_pole, double period, const HalfTurn& turn);

}  // namespace zwidth::internal
