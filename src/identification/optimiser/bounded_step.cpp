#include "identification/optimiser/bounded_step.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <optional>

namespace zwidth::internal {
namespace {

/// The solution on the free elements, those at a bound where they are.
Eigen::VectorXd solved(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient, const Eigen::VectorXd& at,
                       const std::vector<bool>& fixed) {
  std::vector<Eigen::Index> free;
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (!fixed[i]) free.push_back(static_cast<Eigen::Index>(i));
  }
  Eigen::VectorXd step = at;
  if (free.empty()) return step;
  Eigen::MatrixXd own = hessian(free, free);
  Eigen::VectorXd right = -gradient(free);
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    if (fixed[i] && at(static_cast<Eigen::Index>(i)) != 0.0)
      right -= hessian(free, static_cast<Eigen::Index>(i)) * at(static_cast<Eigen::Index>(i));
  }
  // In units in which the diagonal is 1: numbers that the data hardly tell stay apart from rounding.
  constexpr double least = 1e-13;
  const Eigen::VectorXd unit = own.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  own = (unit.asDiagonal() * own * unit.asDiagonal()).eval();
  own.diagonal().array() += least;
  step(free) = unit.cwiseProduct(own.ldlt().solve(unit.cwiseProduct(right)));
  return step;
}

}  // namespace

Eigen::VectorXd bounded_step(const Eigen::MatrixXd& hessian, const Eigen::VectorXd& gradient,
                             const Eigen::VectorXd& lowest, const std::vector<bool>& held) {
  const Eigen::Index size = gradient.size();
  std::vector<bool> fixed(static_cast<std::size_t>(size), false);
  Eigen::VectorXd at = Eigen::VectorXd::Zero(size);
  for (std::size_t i = 0; i < held.size(); ++i) fixed[i] = held[i];
  Eigen::VectorXd step = at;
  for (Eigen::Index pass = 0; pass < 3 * size; ++pass) {
    step = solved(hessian, gradient, at, fixed);
    // The first bound on the way from what is allowed to the solution.
    Eigen::Index worst = -1;
    double most = 0.0;
    for (Eigen::Index i = 0; i < size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (!fixed[k] && step(i) < lowest(i) && lowest(i) - step(i) > most) {
        most = lowest(i) - step(i);
        worst = i;
      }
    }
    if (worst >= 0) {
      fixed[static_cast<std::size_t>(worst)] = true;
      at(worst) = lowest(worst);
      continue;
    }
    // What the solution would draw away from its bound is free again.
    const Eigen::VectorXd slope = hessian * step + gradient;
    Eigen::Index drawn = -1;
    double pull = 0.0;
    for (Eigen::Index i = 0; i < size; ++i) {
      const auto k = static_cast<std::size_t>(i);
      const bool at_bound = fixed[k] && !(k < held.size() && held[k]);
      const double gain = at_bound ? -slope(i) / std::sqrt(std::fmax(hessian(i, i), 1e-300)) : 0.0;
      if (gain > pull + 1e-9) {
        pull = gain;
        drawn = i;
      }
    }
    if (drawn < 0 || pass > 2 * size) break;
    fixed[static_cast<std::size_t>(drawn)] = false;
    at(drawn) = 0.0;
  }
  return step.cwiseMax(lowest);
}

}  // namespace zwidth::internal
