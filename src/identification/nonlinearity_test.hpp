#pragma once

#include <functional>
#include <optional>
#include <span>

#include "identification/nonlinear_forces.hpp"
#include "identification/shot_model.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/stiffness_interval.hpp"

namespace zwidth::internal {

/// What a fit leaves of a record, asked by find_nonlinearity().
struct NonlinearityQuestion {
  const Device& device;  ///< fitted, as it was in the experiment
  std::span<const double> force;
  std::span<const double> position;   ///< recorded
  std::span<const double> residuals;  ///< recorded less fitted position
  std::span<const Shot> shots = {};   ///< what was fitted from a state of its own; empty: the whole record
};

/// Looks for forces that hang on the measured position or on the commanded force in no linear way.
///
///     A(q) (y - y_M) = A(q) sum_j c_j G g_j + linear terms + e,   g_j: clearest_nonlinearity()
///
/// y_M: the fitted motion; A: the autoregression that makes its residuals white; G: the fitted device, x: the recorded
/// position. The linear terms (force at eight samples, position, velocity, its sign, acceleration, a constant force,
/// motion from its beginning) are taken out of either side. A g_j of the past only meets white errors, so that sums of their products have the variance
/// of white noise; where the errors' spectrum is above it, as at frequencies that the autoregression is too short for, of
/// that spectrum. Nothing where the record is too short, or nothing is left. Source: Lagrange multiplier tests of a
/// linear model against additive nonlinear terms (Tsay 1986; Luukkonen, Saikkonen & Terasvirta 1988).
[[nodiscard]] std::optional<Nonlinearity> find_nonlinearity(const NonlinearityQuestion& question);

}  // namespace zwidth::internal
