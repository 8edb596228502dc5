#include "sampling/matrix_exponential.hpp"

#include <cmath>

#include "model/balance.hpp"

namespace zwidth::internal {

Eigen::MatrixXd exponential_minus_one(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXd scales = balancing_scales(matrix);
  Eigen::MatrixXd m = scales.cwiseInverse().asDiagonal() * matrix * scales.asDiagonal();
  const double norm = m.cwiseAbs().rowwise().sum().maxCoeff();
  const int halvings = norm > 0.25 ? static_cast<int>(std::ceil(std::log2(norm / 0.25))) : 0;
  m *= std::ldexp(1.0, -halvings);
  constexpr int terms = 12;  // 0.25^12 / 12! < 1e-16
  Eigen::MatrixXd sum = m;
  Eigen::MatrixXd power = m;
  for (int k = 2; k <= terms; ++k) {
    power = power * m / static_cast<double>(k);
    sum += power;
  }
  for (int i = 0; i < halvings; ++i) sum = 2.0 * sum + sum * sum.eval();
  return scales.asDiagonal() * sum * scales.cwiseInverse().asDiagonal();
}

}  // namespace zwidth::internal
