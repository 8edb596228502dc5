#pragma once

// The motions per force at one point as quotients of polynomials in s, with a hundred digits: zeros that coincide are
// told from zeros that lie close together.

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cstddef>
#include <vector>

#include "model/device_lengths.hpp"
#include "stability/second_route/characteristic_polynomial.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

using ManyDigits =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<100>, boost::multiprecision::et_off>;

// Beyond as many bodies a hundred digits do not hold the coefficients.
inline constexpr std::size_t most_bodies_for_polynomials = 12;

// Relative: what is less is zero. Rounding leaves 1e-60 and less.
inline constexpr double zero_in_digits = 1e-40;

struct MotionPolynomials {
  Polynomial<ManyDigits> determinant;              // det Z(s), Z = s² M + s D + K
  std::vector<Polynomial<ManyDigits>> numerators;  // of each body's or coordinate's position, over the determinant
};

// The device must have bodies or coordinates, most_bodies_for_polynomials at most. From Z's inverse at 2 n + 1 positive s, where it is
// positive definite, by Newton's interpolation.
[[nodiscard]] MotionPolynomials motion_polynomials(const Device& device, const Weights& forced);

}  // namespace zwidth::internal
