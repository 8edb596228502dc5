#pragma once

// Exact integers and ball arithmetic (FLINT and Arb) as values: a number with a proven bound of its error, to as many
// digits as are asked for. Only where double-double does not carry: a ball costs a hundred times as much.

#include <acb.h>
#include <acb_poly.h>
#include <arb_mat.h>
#include <arb_poly.h>
#include <flint/fmpq.h>
#include <flint/fmpz_poly.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "model/extended_precision.hpp"

namespace zwidth::internal {

template <typename Struct, void (*Init)(Struct*), void (*Clear)(Struct*), void (*Set)(Struct*, const Struct*)>
class FlintValue {
 public:
  FlintValue() { Init(&value_); }
  FlintValue(const FlintValue& other) : FlintValue() { Set(&value_, &other.value_); }
  FlintValue& operator=(const FlintValue& other) {
    Set(&value_, &other.value_);
    return *this;
  }
  ~FlintValue() { Clear(&value_); }

  operator Struct*() { return &value_; }              // NOLINT(google-explicit-constructor): FLINT's functions take it
  operator const Struct*() const { return &value_; }  // NOLINT(google-explicit-constructor)
  Struct* operator->() { return &value_; }            // its macros dereference it
  const Struct* operator->() const { return &value_; }

 private:
  Struct value_;
};

using IntegerPolynomial = FlintValue<fmpz_poly_struct, fmpz_poly_init, fmpz_poly_clear, fmpz_poly_set>;
using RealBall = FlintValue<arb_struct, arb_init, arb_clear, arb_set>;
using ComplexBall = FlintValue<acb_struct, acb_init, acb_clear, acb_set>;
using RealBallPolynomial = FlintValue<arb_poly_struct, arb_poly_init, arb_poly_clear, arb_poly_set>;
using ComplexBallPolynomial = FlintValue<acb_poly_struct, acb_poly_init, acb_poly_clear, acb_poly_set>;

class BallMatrix {
 public:
  BallMatrix(std::size_t rows, std::size_t columns) {
    arb_mat_init(matrix_, static_cast<slong>(rows), static_cast<slong>(columns));
  }
  BallMatrix(const BallMatrix&) = delete;
  BallMatrix& operator=(const BallMatrix&) = delete;
  ~BallMatrix() { arb_mat_clear(matrix_); }
  arb_struct* operator()(std::size_t i, std::size_t j) {
    return arb_mat_entry(matrix_, static_cast<slong>(i), static_cast<slong>(j));
  }
  operator arb_mat_struct*() { return matrix_; }  // NOLINT(google-explicit-constructor)

 private:
  arb_mat_t matrix_;
};

// The midpoint in double-double.
inline Extended rounded(const arb_struct* ball) {
  const double high = arf_get_d(arb_midref(ball), ARF_RND_NEAR);
  if (!std::isfinite(high)) return {high};
  RealBall low;
  arf_set_d(arb_midref(low), high);
  arf_sub(arb_midref(low), arb_midref(ball), arb_midref(low), slong{2} * 53, ARF_RND_NEAR);
  return Extended(high) + Extended(arf_get_d(arb_midref(low), ARF_RND_NEAR));
}

// A double-double as a ball without error.
inline RealBall exact_ball(const Extended& value) {
  RealBall ball;
  RealBall low;
  arb_set_d(ball, value.x[0]);
  arb_set_d(low, value.x[1]);
  arb_add(ball, ball, low, ARF_PREC_EXACT);
  return ball;
}

// All coefficients of a polynomial of `count` coefficients in double-double, or nothing when the balls are too wide:
// each must be known to 2^-digits of itself, or of the largest one where coefficients are weighed by |s| = scale.
inline std::optional<std::vector<Extended>> rounded_coefficients(const RealBallPolynomial& p, std::size_t count,
                                                                 double scale) {
  constexpr int digits_of_itself = 108;
  constexpr int digits_of_largest = 160;
  const double log_scale = std::log2(scale);
  const auto log_size = [](const arb_struct* ball) {  // of the midpoint, to a factor of two; exponents may be huge
    return arf_is_zero(arb_midref(ball)) ? -1e300 : static_cast<double>(arf_abs_bound_lt_2exp_si(arb_midref(ball)));
  };
  const auto log_radius = [](const arb_struct* ball) {
    if (mag_is_zero(arb_radref(ball))) return -1e300;
    return static_cast<double>(MAG_EXP(arb_radref(ball)));
  };
  RealBall coefficient;
  double largest = -1e300;
  for (std::size_t i = 0; i < count; ++i) {
    arb_poly_get_coeff_arb(coefficient, p, static_cast<slong>(i));
    if (!arb_is_finite(coefficient)) return std::nullopt;
    largest = std::max(largest, log_size(coefficient) + static_cast<double>(i) * log_scale);
  }
  std::vector<Extended> result(count, Extended(0.0));
  for (std::size_t i = 0; i < count; ++i) {
    arb_poly_get_coeff_arb(coefficient, p, static_cast<slong>(i));
    const double radius = log_radius(coefficient);
    const bool known = radius <= log_size(coefficient) - digits_of_itself;
    const bool negligible = radius + static_cast<double>(i) * log_scale <= largest - digits_of_largest;
    if (!known && !negligible) return std::nullopt;
    if (!arb_contains_zero(coefficient)) result[i] = rounded(coefficient);
  }
  return result;
}

}  // namespace zwidth::internal
