#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstddef>

#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {

/// x[k+1] = (I + Phi) x[k] + Gamma1 u[k-l] + Gamma2 u[k-l-1], y[k] = C x[k], the exact sampled device.
///
/// Phi = e^{AT} - I is kept rather than F = e^{AT}, whose digits are lost to the 1 on its diagonal at fast sampling.
struct DiscreteStateSpace {
  double period = 0.0;            ///< T, s
  Eigen::MatrixXd Phi;            ///< n x n
  Eigen::VectorXd Gamma1;         ///< n x 1
  Eigen::VectorXd Gamma2;         ///< n x 1, zero when the delay is a whole number of samples
  Eigen::RowVectorXd C;           ///< 1 x n
  std::size_t delay_samples = 0;  ///< l
};

/// Exact zero-order-hold sampling with any real delay, by the matrix exponential; independent of modal_form().
/// Throws Error (invalid_argument) for a period or delay outside its domain.
[[nodiscard]] DiscreteStateSpace sample(const ContinuousStateSpace& system, Sampling sampling);

/// The same plant with the delayed forces as states: x[k+1] = (I + Phi) x[k] + Gamma1 u[k], y = C x, no delay left.
/// Shapes grow by l (+ 1 when the delay is fractional).
[[nodiscard]] DiscreteStateSpace with_delay_states(const DiscreteStateSpace& system);

/// C ((z - 1) I - Phi)^-1 (Gamma1 + Gamma2 z^-1) z^-l at z = e^{jwT}, w in rad/s.
[[nodiscard]] std::complex<double> response(const DiscreteStateSpace& system, double frequency);

}  // namespace zwidth
