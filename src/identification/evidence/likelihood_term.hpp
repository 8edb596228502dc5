#pragma once

#include <Eigen/Core>
#include <optional>

#include "identification/optimiser/least_squares_problem.hpp"

namespace zwidth::internal {

/// A part of the likelihood: what one kind of measurement says of the numbers of a fit, with elements that only it has.
class LikelihoodTerm {
 public:
  LikelihoodTerm() = default;
  LikelihoodTerm(const LikelihoodTerm&) = delete;
  LikelihoodTerm& operator=(const LikelihoodTerm&) = delete;
  virtual ~LikelihoodTerm() = default;

  /// Bounds of its own elements, one each; minus infinity where there is none.
  [[nodiscard]] virtual Eigen::VectorXd own_lowest() const = 0;
  /// Its own elements to start from, where the numbers are x.
  [[nodiscard]] virtual Eigen::VectorXd own_start(const Eigen::VectorXd& x) const = 0;
  /// Minus the log-likelihood, without what is constant. Nothing where it cannot be computed.
  [[nodiscard]] virtual std::optional<double> cost(const Eigen::VectorXd& x, const Eigen::VectorXd& own) const = 0;
  /// Adds cost, gradient and curvature to `sum`, whose first elements are x; its own elements begin at `at`.
  /// False, and `sum` as it was, where they cannot be computed.
  [[nodiscard]] virtual bool add_picture(const Eigen::VectorXd& x, const Eigen::VectorXd& own, Eigen::Index at,
                                         Picture& sum) const = 0;
};

}  // namespace zwidth::internal
