#pragma once

#include <optional>
#include <span>
#include <string>

#include "identification/shot_model.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// What a fit leaves of a record, asked by find_nonlinearity().
struct NonlinearityQuestion {
  const Device& device;  ///< fitted, as it was in the experiment
  std::span<const double> force;
  std::span<const double> position;   ///< recorded
  std::span<const double> residuals;  ///< recorded less fitted position
  std::span<const Shot> shots = {};   ///< what was fitted from a state of its own; empty: the whole record
};

/// What a linear device with dry friction does not do.
struct Nonlinearity {
  std::string what;  ///< in words, with its likely cause
  std::string remedy;
  double evidence = 0.0;  ///< chi-squared, over its degrees of freedom
  double share = 0.0;     ///< of the squares of what is left, as prediction errors
};

/// Looks for forces that hang on the measured position or on the commanded force in no linear way.
///
///     A(q) (y - y_M) = A(q) sum_j c_j G g_j + linear terms + e,   g_j: cos and sin of 2 pi n x / range, n = 1..100
///     (each n by itself); x^2, x^3; the part of the force beyond 1/4, 1/2 and 3/4 of its largest
///
/// y_M: the fitted motion; A: the autoregression that makes its residuals white; G: the fitted device, x: the recorded
/// position. The linear terms (force at eight samples, position, velocity, its sign,
/// acceleration, a constant force) are taken out of either side. A g_j of the past only meets white errors, so that sums
/// of their products have the variance of white noise. Said where chi-squared and the share explained are both beyond
/// what records of linear devices show. Nothing where the record is too short, or nothing is left. Source: Lagrange
/// multiplier tests of a linear model against additive nonlinear terms (Tsay 1986; Luukkonen, Saikkonen & Terasvirta
/// 1988).
[[nodiscard]] std::optional<Nonlinearity> find_nonlinearity(const NonlinearityQuestion& question);

}  // namespace zwidth::internal
