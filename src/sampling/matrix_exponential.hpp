#pragma once

#include <Eigen/Core>
#include <vector>

namespace zwidth::internal {

// e^M - I by Taylor series and E <- 2 E + E² for each halving of M; keeps the digits that e^M loses to its diagonal.
Eigen::MatrixXd exponential_minus_one(const Eigen::MatrixXd& matrix);

struct ExponentialWithDerivatives {
  Eigen::MatrixXd minus_one;                 // e^M - I
  std::vector<Eigen::MatrixXd> derivatives;  // de^M/dp, one per dM/dp
};
// The same with its Frechet derivatives, by the derivative of each step.
ExponentialWithDerivatives exponential_with_derivatives(const Eigen::MatrixXd& matrix,
                                                        const std::vector<Eigen::MatrixXd>& derivatives);

}  // namespace zwidth::internal
