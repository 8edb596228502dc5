#pragma once

#include <Eigen/Core>

namespace zwidth::internal {

/// Eigenvalues by rising size and, column by column, orthonormal eigenvectors of a real symmetric matrix.
///
/// A function, so that Eigen's solver is compiled once: it takes a compiler seven seconds wherever it is used.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

/// The eigenvalues alone.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

}  // namespace zwidth::internal
