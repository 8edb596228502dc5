#pragma once

// A function on an interval, in the normalised variable u in [-1, 1]: value and slope at the centre and a bound of the
// second derivative on the whole interval (a Taylor model of first order). With it
//
//     |f(u) - value - slope u| <= bend / 2
//
// so that "no root here" and "at most one root here" are decided for the interval, not for points of a grid.
// `weight` times a few rounding units bounds the rounding of value and slope: of a sum that of the terms together, of a
// product that of either factor times the size of the other, so that what a small factor keeps in digits stays.
// Scalar is double, or Extended where double cannot tell f from zero.

#include <cmath>
#include <concepts>
#include <limits>

#include "model/extended_precision.hpp"

namespace zwidth::internal {

// The few rounding units: evaluation takes some dozen operations per modal term.
template <typename Scalar>
inline constexpr double rounding_of_jets = 256.0 * std::numeric_limits<double>::epsilon();
template <>
inline constexpr double rounding_of_jets<Extended> = 1e-28;

template <typename Scalar>
struct BoundedJet {
  Scalar value{0.0};
  Scalar slope{0.0};
  double bend = 0.0;    // >= sup |f''|
  double weight = 0.0;  // >= sup |f|; rounding over rounding_of_jets

  BoundedJet() = default;
  explicit BoundedJet(double constant) : value(constant), weight(std::abs(constant)) {}
  BoundedJet(const Scalar& value_at_centre, const Scalar& slope_at_centre, double bend_bound, double weight_bound)
      : value(value_at_centre), slope(slope_at_centre), bend(bend_bound), weight(weight_bound) {}

  [[nodiscard]] double size() const {
    return std::abs(leading(value)) + std::abs(leading(slope)) + 0.5 * bend;
  }                                                                                    // >= sup |f|
  [[nodiscard]] double slope_size() const { return std::abs(leading(slope)) + bend; }  // >= sup |f'|

  [[gnu::always_inline]] friend BoundedJet operator+(const BoundedJet& a, const BoundedJet& b) {
    return {a.value + b.value, a.slope + b.slope, a.bend + b.bend, a.weight + b.weight};
  }
  [[gnu::always_inline]] friend BoundedJet operator-(const BoundedJet& a, const BoundedJet& b) {
    return {a.value - b.value, a.slope - b.slope, a.bend + b.bend, a.weight + b.weight};
  }
  [[gnu::always_inline]] friend BoundedJet operator-(const BoundedJet& a) {
    return {-a.value, -a.slope, a.bend, a.weight};
  }
  [[gnu::always_inline]] friend BoundedJet operator+(const BoundedJet& a, double c) {
    return {a.value + c, a.slope, a.bend, a.weight + std::abs(c)};
  }
  [[gnu::always_inline]] friend BoundedJet operator+(const BoundedJet& a,
                                                     const Extended& c) requires(!std::same_as<Scalar, double>) {
    return {a.value + c, a.slope, a.bend, a.weight + std::abs(leading(c))};
  }
  [[gnu::always_inline]] friend BoundedJet operator-(double c, const BoundedJet& a) {
    return {c - a.value, -a.slope, a.bend, a.weight + std::abs(c)};
  }
  [[gnu::always_inline]] friend BoundedJet operator*(double c, const BoundedJet& a) {
    const double size = std::abs(c);
    return {c * a.value, c * a.slope, size * a.bend, size * a.weight};
  }
  // (f g)'' = f'' g + 2 f' g' + f g''
  [[gnu::always_inline]] friend BoundedJet operator*(const BoundedJet& a, const BoundedJet& b) {
    const double a_size = a.size();
    const double b_size = b.size();
    return {a.value * b.value, a.value * b.slope + a.slope * b.value,
            a.bend * b_size + 2.0 * a.slope_size() * b.slope_size() + a_size * b.bend,
            (a_size + rounding_of_jets<Scalar> * a.weight) * b.weight + a.weight * b_size};
  }
  [[gnu::always_inline]] friend BoundedJet square(const BoundedJet& a) {
    const double size = a.size();
    const double slope_size = a.slope_size();
    return {a.value * a.value, 2.0 * (a.value * a.slope), 2.0 * (a.bend * size + slope_size * slope_size),
            (2.0 * size + rounding_of_jets<Scalar> * a.weight) * a.weight};
  }
};

}  // namespace zwidth::internal
