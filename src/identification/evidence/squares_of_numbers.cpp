#include "identification/evidence/squares_of_numbers.hpp"

#include "identification/evidence/difference_slopes.hpp"

namespace zwidth::internal {

std::optional<double> SquaresOfNumbers::cost(const Eigen::VectorXd& x, const Eigen::VectorXd& /*own*/) const {
  const auto left = residuals(x);
  if (!left) return std::nullopt;
  return 0.5 * left->squaredNorm();
}

bool SquaresOfNumbers::add_picture(const Eigen::VectorXd& x, const Eigen::VectorXd& /*own*/, Eigen::Index /*at*/,
                                   Picture& sum) const {
  const auto left = residuals(x);
  if (!left) return false;
  const auto slopes =
      difference_slopes(family_, x, *left, [&](const Eigen::VectorXd& moved) { return residuals(moved); });
  if (!slopes) return false;
  sum.cost += 0.5 * left->squaredNorm();
  sum.gradient.head(x.size()) += slopes->transpose() * *left;
  sum.hessian.topLeftCorner(x.size(), x.size()) += slopes->transpose() * *slopes;
  return true;
}

}  // namespace zwidth::internal
