#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// How a parameter acts: on A of the motion (motion_matrix()), or as so much more delay.
struct ResponseChange {
  Eigen::MatrixXd matrix = {};  ///< dA/dp; empty: 0
  double delay = 0.0;           ///< s per p
};

/// dG/dp at each frequency, a column per parameter, in state space:
///
///     G = C (sigma I - F)^-1 g e,    dG = y^T (dF x + dg) e,    x = (sigma I - F)^-1 g,    y = (sigma I - F)^-T C
///
/// sampled with sigma = z - 1, F = e^{AT} - I, g = Gamma1 + Gamma2 z^-1 and e = z^-l (discrete_state_space.hpp) where a
/// period is given, else with sigma = jw, F = A, g = B and e = e^{-jw t_d}; F in Schur's form, once for all frequencies.
/// The device has no friction. Nothing where doubles do not carry: where G is not `values`, which the modal form gave, to seven digits everywhere.
[[nodiscard]] std::optional<Eigen::MatrixXcd> response_slopes(const Device& device, std::optional<double> period,
                                                              const std::vector<ResponseChange>& changes,
                                                              const std::vector<double>& frequencies,
                                                              const Eigen::VectorXcd& values);

}  // namespace zwidth::internal
