#pragma once

#include "stability/users/digit_roots.hpp"
#include "stability/users/sharp_zero.hpp"

namespace zwidth::internal {

/// The polynomials of a device, and what is made of them at each zero.
struct MotionsInDigits {
  DigitPolynomial sensed;
  DigitPolynomial actuated;
  DigitPolynomial determinant;
  DigitPolynomial dissipation;  // in X = w²
};

/// `depth`: relative to w0; 0 exactly for a zero on the axis.
[[nodiscard]] SharpZero sharp_zero(const MotionsInDigits& of, const ManyDigits& w0, const ManyDigits& depth,
                                   const DrivePath& drive);

}  // namespace zwidth::internal
