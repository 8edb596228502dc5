#pragma once

#include <Eigen/Core>
#include <vector>

namespace zwidth::internal {

// e^M - I by Taylor series and E <- 2 E + E² for each halving of M; keeps the digits that e^M loses to its diagonal.
Eigen::MatrixXd exponential_minus_one(const Eigen::MatrixXd& matrix);

struct ExponentialWithSlopes {
  Eigen::MatrixXd minus_one;            // e^M - I
  std::vector<Eigen::MatrixXd> slopes;  // de^M/dp, one per dM/dp
};
// The same with its Frechet derivatives, by the derivative of each step.
ExponentialWithSlopes exponential_with_slopes(const Eigen::MatrixXd& matrix,
                                              const std::vector<Eigen::MatrixXd>& slopes);

}  // namespace zwidth::internal
