#pragma once

#include <Eigen/Core>
#include <vector>

namespace zwidth::internal {

/// The step d that makes d'H d / 2 + g'd least with d >= lowest, by an active set; `held` elements stay.
///
/// H must be positive definite on what moves; a little is added to its diagonal where it is not.
[[nodiscard]] Eigen::VectorXd bounded_step(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                                           const Eigen::VectorXd& lowest, const std::vector<bool>& held = {});

}  // namespace zwidth::internal
