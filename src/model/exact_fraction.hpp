#pragma once

// G(s) of a device without any rounding: the numbers of a device are doubles, hence rational.

#include "model/balls.hpp"
#include "model/device_lengths.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// G = 2^exponent numerator(s) / denominator(s), the actuator's lag not included.
struct ExactFraction {
  IntegerPolynomial numerator;
  IntegerPolynomial denominator;
  long exponent = 0;
};

ExactFraction exact_fraction(const TransferFunction& transfer_function);
// Throws Error (did_not_converge) for more bodies than the exact determinant can take.
// `denominator`: the device's, of degree -1 while it is not known.
ExactFraction exact_fraction(const Device& device, const WeightedPath& path, IntegerPolynomial& denominator);

}  // namespace zwidth::internal
