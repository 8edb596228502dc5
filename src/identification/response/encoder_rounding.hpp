#pragma once

#include <complex>
#include <span>

namespace zwidth::internal {

/// What an encoder rounds off in step with a sweep's motion. Segments that hold the same sweep round alike, so their scatter
/// does not show it. Of a sine of `a` steps with noise of `s` steps (one deviation) under it, over all offsets from a count,
/// as a share of the motion's power
///
///     sum_n 2 J_1(2 pi n a)^2 / (pi n a)^2 exp(-(2 pi n s)^2),   at most 1
///
/// with J_1(z)^2 by its envelope, min(z^2 / 4, 1 / (pi z)): the rounding error is a Fourier series of the position, and the
/// sine's part of each term is a Bessel function (Jacobi-Anger). On such errors: Widrow & Kollar, Quantization Noise, 2008.
class SweepRounding {
 public:
  /// Of a force that is one sine at any time and a position in whole steps; of others there is none.
  SweepRounding(std::span<const double> force, std::span<const double> position);

  /// What it adds to the variance of a response of this value.
  [[nodiscard]] double variance(std::complex<double> value) const;

 private:
  double force_ = 0.0;  ///< amplitude
  double step_ = 0.0;
  double noise_ = 0.0;  ///< steps
};

/// The largest motion that may be rounding alone: half a step of a position in whole steps, where the noise under it is too
/// little to dither it: of 0.4 steps at most 2 exp(-2 pi^2 0.4^2) = 8.5 % of a small motion is in the rounding error. Else 0.
[[nodiscard]] double largest_rounding(std::span<const double> position);

}  // namespace zwidth::internal
