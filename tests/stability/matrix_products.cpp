#include "stability/matrix_products.hpp"

#include <Eigen/Dense>
#include <complex>

namespace zwidth::test {

Eigen::MatrixXd product(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) { return a * b; }

Eigen::MatrixXcd complex_product(const Eigen::MatrixXcd& a, const Eigen::MatrixXcd& b) { return a * b; }

Eigen::MatrixXcd complex_of(const Eigen::MatrixXd& real) { return real.cast<std::complex<double>>(); }

void add_square(Eigen::MatrixXd& to, double weight, const Eigen::VectorXd& along) {
  for (Eigen::Index i = 0; i < along.size(); ++i) to.col(i) += weight * along(i) * along;
}

Eigen::MatrixXcd solution(const Eigen::MatrixXcd& of, const Eigen::MatrixXcd& right) {
  return of.partialPivLu().solve(right);
}

Eigen::MatrixXcd inverse_of(const Eigen::MatrixXcd& of) {
  return solution(of, Eigen::MatrixXcd::Identity(of.rows(), of.cols()));
}

Eigen::VectorXcd eigenvalues_of(const Eigen::MatrixXcd& a) {
  return Eigen::ComplexEigenSolver<Eigen::MatrixXcd>(a, false).eigenvalues();
}

Axes axes_of(const Eigen::MatrixXd& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (a + a.transpose()));
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace zwidth::test
