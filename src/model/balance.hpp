#pragma once

#include <Eigen/Core>

namespace zwidth::internal {

// Powers of two d such that diag(d)^-1 M diag(d) has rows and columns of similar norm (Parlett and Reinsch 1969), so
// that exponentials and eigenvalues of matrices with mixed units keep their digits.
Eigen::VectorXd balancing_scales(const Eigen::MatrixXd& matrix);

}  // namespace zwidth::internal
