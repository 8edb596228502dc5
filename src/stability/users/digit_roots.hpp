#pragma once

// Roots of real polynomials with a hundred digits, those of higher multiplicity among them.

#include <cstddef>
#include <optional>

#include "stability/users/motion_polynomials.hpp"

namespace zwidth::internal {

using DigitPolynomial = Polynomial<ManyDigits>;  // by rising powers

/// X² + u X + v
struct Quadratic {
  ManyDigits u;
  ManyDigits v;
};

/// |N(jw)|² as a polynomial in X = w².
[[nodiscard]] DigitPolynomial squared_size(const DigitPolynomial& numerator);

/// p(x (1 + e)) by rising powers of e.
[[nodiscard]] DigitPolynomial taylor(DigitPolynomial p, const ManyDigits& x);

/// How many of the first coefficients vanish.
[[nodiscard]] std::size_t multiplicity(const DigitPolynomial& p);

/// The quadratic factor beside `q`, by Bairstow's method, which converges quadratically also where its two roots are
/// one; nothing where it does not settle.
[[nodiscard]] std::optional<Quadratic> quadratic_factor(const DigitPolynomial& a, Quadratic q);

/// The root of multiplicity m beside `start`: that of the (m - 1)th derivative, if it is one of all lower ones.
[[nodiscard]] std::optional<ManyDigits> multiple_root(const DigitPolynomial& p, std::size_t m, ManyDigits start);

}  // namespace zwidth::internal
