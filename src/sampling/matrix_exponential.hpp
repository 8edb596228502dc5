#pragma once

#include <Eigen/Core>

namespace zwidth::internal {

// e^M - I by Taylor series and E <- 2 E + E² for each halving of M; keeps the digits that e^M loses to its diagonal.
Eigen::MatrixXd exponential_minus_one(const Eigen::MatrixXd& matrix);

}  // namespace zwidth::internal
