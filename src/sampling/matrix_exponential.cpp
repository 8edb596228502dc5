#include "sampling/matrix_exponential.hpp"

#include <cmath>
#include <utility>

#include "model/balance.hpp"

namespace zwidth::internal {

Eigen::MatrixXd exponential_minus_one(const Eigen::MatrixXd& matrix) {
  return exponential_with_derivatives(matrix, {}).minus_one;
}

ExponentialWithDerivatives exponential_with_derivatives(const Eigen::MatrixXd& matrix,
                                                        const std::vector<Eigen::MatrixXd>& derivatives) {
  const Eigen::VectorXd scales = balancing_scales(matrix);
  Eigen::MatrixXd m = scales.cwiseInverse().asDiagonal() * matrix * scales.asDiagonal();
  const double norm = m.cwiseAbs().rowwise().sum().maxCoeff();
  const int halvings = norm > 0.25 ? static_cast<int>(std::ceil(std::log2(norm / 0.25))) : 0;
  const double part = std::ldexp(1.0, -halvings);
  m *= part;
  constexpr int terms = 12;                   // 0.25^12 / 12! < 1e-16
  std::vector<Eigen::MatrixXd> powers = {m};  // M^k / k!
  for (int k = 2; k <= terms; ++k) powers.emplace_back(powers.back().lazyProduct(m) / static_cast<double>(k));
  Eigen::MatrixXd sum = m;
  for (int k = 1; k < terms; ++k) sum += powers[static_cast<std::size_t>(k)];
  std::vector<Eigen::MatrixXd> sums = {sum};  // before each doubling, and the last
  for (int i = 0; i < halvings; ++i) sums.emplace_back(2.0 * sums.back() + sums.back().lazyProduct(sums.back()));

  ExponentialWithDerivatives result;
  for (const Eigen::MatrixXd& each : derivatives) {
    const Eigen::MatrixXd slope = part * (scales.cwiseInverse().asDiagonal() * each * scales.asDiagonal());
    Eigen::MatrixXd of_power = slope;
    Eigen::MatrixXd of_sum = slope;
    Eigen::MatrixXd next = slope;
    for (int k = 2; k <= terms; ++k) {
      next.noalias() = of_power.lazyProduct(m);
      next += powers[static_cast<std::size_t>(k - 2)].lazyProduct(slope);
      of_power = next / static_cast<double>(k);
      of_sum += of_power;
    }
    for (int i = 0; i < halvings; ++i) {
      const Eigen::MatrixXd& before = sums[static_cast<std::size_t>(i)];
      next = 2.0 * of_sum;
      next += of_sum.lazyProduct(before);
      next += before.lazyProduct(of_sum);
      std::swap(of_sum, next);
    }
    result.derivatives.emplace_back(scales.asDiagonal() * of_sum * scales.cwiseInverse().asDiagonal());
  }
  result.minus_one = scales.asDiagonal() * sums.back() * scales.cwiseInverse().asDiagonal();
  return result;
}

}  // namespace zwidth::internal
