#include "linear_systems.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace zwidth::internal {

Eigen::VectorXd solve(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.partialPivLu().solve(right);
}

Eigen::VectorXd solve_pivoted(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.fullPivLu().solve(right);
}

Eigen::MatrixXcd solve_complex_columns(const Eigen::MatrixXcd& matrix, const Eigen::MatrixXcd& right) {
  return matrix.partialPivLu().solve(right);
}

Eigen::VectorXcd solve_complex(const Eigen::MatrixXcd& matrix, const Eigen::VectorXcd& right) {
  return matrix.fullPivLu().solve(right);
}

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.ldlt().solve(right);
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& matrix) { return matrix.fullPivLu().inverse(); }

Eigen::MatrixXd inverse_of_symmetric(const Eigen::MatrixXd& matrix) {
  return matrix.ldlt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

Eigen::VectorXd least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

Eigen::MatrixXd least_squares_of_columns(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right) {
  return matrix.colPivHouseholderQr().solve(right);
}

ShortestSolution shortest_least_squares(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  // The pseudo-inverse of the small triangle: that of the tall matrix takes as many solutions as it has rows.
  const Eigen::HouseholderQR<Eigen::MatrixXd> tall(matrix);
  const Eigen::Index size = matrix.cols();
  const Eigen::MatrixXd triangle = tall.matrixQR().topRows(size).triangularView<Eigen::Upper>();
  const Eigen::MatrixXd inverse = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(triangle).pseudoInverse();
  const Eigen::VectorXd turned = tall.householderQ().adjoint() * right;
  return {inverse * turned.head(size), inverse.rowwise().norm()};
}

Eigen::MatrixXd outside_span(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& matrix, double rank_tolerance) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  qr.setThreshold(rank_tolerance);
  Eigen::MatrixXd turned = qr.householderQ().adjoint() * columns;
  turned.topRows(qr.rank()).setZero();
  return qr.householderQ() * turned;
}

Eigen::MatrixXd orthonormal_basis(const Eigen::MatrixXd& matrix, double rank_tolerance) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  qr.setThreshold(rank_tolerance);
  const Eigen::MatrixXd first = Eigen::MatrixXd::Identity(matrix.rows(), qr.rank());
  return qr.householderQ() * first;
}

Eigen::MatrixXd orthonormal_complement(const Eigen::MatrixXd& matrix, double rank_tolerance) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  qr.setThreshold(rank_tolerance);
  const Eigen::MatrixXd all = Eigen::MatrixXd::Identity(matrix.rows(), matrix.rows());
  return qr.householderQ() * all.rightCols(matrix.rows() - qr.rank());
}

Eigen::Index rank(const Eigen::MatrixXd& matrix, double rank_tolerance) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  qr.setThreshold(rank_tolerance);
  return qr.rank();
}

Eigen::MatrixXd shortest_solutions(const Eigen::MatrixXd& matrix, const Eigen::MatrixXd& right, double rank_tolerance) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(rank_tolerance);
  decomposition.compute(matrix);
  return decomposition.solve(right);
}

Eigen::MatrixXd basis_above(const Eigen::MatrixXd& matrix, double least) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(matrix);
  Eigen::Index rank = 0;
  while (rank < matrix.cols() && std::abs(qr.matrixQR()(rank, rank)) > least) ++rank;
  return qr.householderQ() * Eigen::MatrixXd::Identity(matrix.rows(), rank);
}

Eigen::MatrixXd inverse_of_squares(const Eigen::MatrixXd& matrix) {
  return (matrix.transpose() * matrix).ldlt().solve(Eigen::MatrixXd::Identity(matrix.cols(), matrix.cols()));
}

Eigen::MatrixXd inverse_of_positive(const Eigen::MatrixXd& matrix) {
  return matrix.llt().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
}

Cholesky cholesky(const Eigen::MatrixXd& matrix) {
  Cholesky result;
  result.lower = matrix.llt().matrixL();
  result.inverse =
      result.lower.triangularView<Eigen::Lower>().solve(Eigen::MatrixXd::Identity(matrix.rows(), matrix.cols()));
  return result;
}

}  // namespace zwidth::internal
