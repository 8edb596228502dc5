#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "zwidth/sampling/discrete_state_space.hpp"

namespace zwidth {

/// The exact sampled device moving sample by sample from rest, in constant memory and time per sample.
///
///     x[k+1] = (I + Phi) x[k] + Gamma1 u[k-l] + Gamma2 u[k-l-1],  y[k] = C x[k],  x[0] = 0
///
/// Exact for a force that is held over each period: the continuous device is met at every sample.
class ForcedMotion {
 public:
  /// At rest.
  explicit ForcedMotion(DiscreteStateSpace system);

  /// The position y[k]; then takes u[k], the force from now to the next sample.
  [[nodiscard]] double step(double force);

 private:
  DiscreteStateSpace system_;
  Eigen::VectorXd state_;
  Eigen::VectorXd change_;
  std::vector<double> past_forces_;  ///< ring of the last l + 1 forces
  std::size_t oldest_ = 0;
};

/// The positions y[0], y[1], ... under these forces, from rest. Source: docs/theory.md, "The loop".
[[nodiscard]] std::vector<double> forced_response(const DiscreteStateSpace& system, std::span<const double> force);

}  // namespace zwidth
