#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "identification/evidence/likelihood_term.hpp"
#include "identification/model/number.hpp"

namespace zwidth::internal {

/// The likelihood of everything measured, times what is believed of the numbers beforehand.
///
/// z: the numbers' coordinates, then the own elements of each evidence in turn.
///
///     cost(z) = sum_i ((x_i - expected_i) / deviation_i)^2 / 2 + sum of the evidences' costs
class Likelihood : public LeastSquaresProblem {
 public:
  /// `tell` is called at each picture; what it throws ends the work.
  Likelihood(std::vector<Number> numbers, std::vector<std::shared_ptr<const LikelihoodTerm>> terms,
             std::function<void()> tell = {});

  [[nodiscard]] Eigen::VectorXd lowest() const override;
  [[nodiscard]] std::optional<double> cost(const Eigen::VectorXd& z) const override;
  [[nodiscard]] std::optional<Picture> picture(const Eigen::VectorXd& z) const override;
  /// x with the own elements that the evidences start from.
  [[nodiscard]] Eigen::VectorXd start(const Eigen::VectorXd& x) const;

 private:
  [[nodiscard]] Eigen::Index count() const { return static_cast<Eigen::Index>(numbers_.size()); }

  std::vector<Number> numbers_;
  std::vector<std::shared_ptr<const LikelihoodTerm>> terms_;
  std::function<void()> tell_;
};

}  // namespace zwidth::internal
