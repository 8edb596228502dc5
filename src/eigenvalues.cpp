#include "eigenvalues.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace zwidth::internal {

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::EigenSolver<Eigen::MatrixXd>(matrix, false).eigenvalues();
}

EigenDecomposition eigen_decomposition(const Eigen::MatrixXd& matrix) {
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(matrix);
  const Eigen::MatrixXcd right = solver.eigenvectors();
  return {solver.eigenvalues(), right, right.inverse()};
}

Eigen::VectorXcd complex_eigenvalues(const Eigen::MatrixXcd& matrix) {
  return Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(matrix, false).eigenvalues();
}

ComplexEigen complex_eigen(const Eigen::MatrixXcd& matrix) {
  const Eigen::ComplexEigenSolver<Eigen::MatrixXcd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(matrix);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXd symmetric_eigenvalues(const Eigen::MatrixXd& matrix) {
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix, Eigen::EigenvaluesOnly).eigenvalues();
}

Hessenberg hessenberg(const Eigen::MatrixXd& matrix) {
  if (matrix.rows() < 3) return {matrix, Eigen::MatrixXd::Identity(matrix.rows(), matrix.rows())};
  const Eigen::HessenbergDecomposition<Eigen::MatrixXd> decomposition(matrix);
  return {decomposition.matrixH(), decomposition.matrixQ()};
}

}  // namespace zwidth::internal
