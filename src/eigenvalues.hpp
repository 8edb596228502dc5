#pragma once

#include <Eigen/Core>

namespace zwidth::internal {

// Functions, so that each of Eigen's solvers is compiled once: they take a compiler seven seconds wherever they are used.

/// Eigenvalues of a real square matrix, in no particular order.
Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix);

/// The same with right eigenvectors, column by column, and left ones, row by row: left * right = 1.
struct EigenDecomposition {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd right;
  Eigen::MatrixXcd left;
};
EigenDecomposition eigen_decomposition(const Eigen::MatrixXd& matrix);

/// Eigenvalues of a complex square matrix, in no particular order.
Eigen::VectorXcd complex_eigenvalues(const Eigen::MatrixXcd& matrix);

/// The same with right eigenvectors, column by column, of length 1.
struct ComplexEigen {
  Eigen::VectorXcd values;
  Eigen::MatrixXcd vectors;
};
ComplexEigen complex_eigen(const Eigen::MatrixXcd& matrix);

/// Eigenvalues by rising size and, column by column, orthonormal eigenvectors of a real symmetric matrix.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix);

/// The eigenvalues alone.
Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix);

/// matrix = basis H basis^T with an orthonormal basis; H has nothing below its first subdiagonal.
struct Hessenberg {
  Eigen::MatrixXd matrix;  // H
  Eigen::MatrixXd basis;
};
Hessenberg hessenberg(const Eigen::MatrixXd& matrix);

}  // namespace zwidth::internal
