#pragma once

#include <Eigen/Core>
#include <optional>

namespace zwidth::internal {

/// Half the squares of a problem's residuals, and their second-order picture by Gauss and Newton.
struct Picture {
  double cost = 0.0;         ///< r'r / 2: minus the log-likelihood
  Eigen::VectorXd gradient;  ///< J'r
  Eigen::MatrixXd hessian;   ///< J'J
};

/// What is made small.
class LeastSquaresProblem {
 public:
  LeastSquaresProblem() = default;
  LeastSquaresProblem(const LeastSquaresProblem&) = delete;
  LeastSquaresProblem& operator=(const LeastSquaresProblem&) = delete;
  virtual ~LeastSquaresProblem() = default;

  [[nodiscard]] virtual Eigen::VectorXd lowest() const = 0;  ///< bounds, minus infinity where there is none
  /// Nothing where the residuals cannot be computed.
  [[nodiscard]] virtual std::optional<double> cost(const Eigen::VectorXd& z) const = 0;
  [[nodiscard]] virtual std::optional<Picture> picture(const Eigen::VectorXd& z) const = 0;
};

}  // namespace zwidth::internal
