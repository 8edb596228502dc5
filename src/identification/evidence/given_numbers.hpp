#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "identification/evidence/squares_of_numbers.hpp"
#include "zwidth/model/uncertainty.hpp"

namespace zwidth::internal {

/// What a device file says of its numbers: their values, and the covariance of these.
///
///     cost = (v(x) - v_file)' C^-1 (v(x) - v_file) / 2
class GivenNumbers : public SquaresOfNumbers {
 public:
  /// Directions that the covariance leaves no width are left out. `file`: a device with every number of `uncertainty`.
  GivenNumbers(const DeviceFamily& family, const DeviceParameters& file, const Uncertainty& uncertainty);

  [[nodiscard]] std::optional<Eigen::VectorXd> residuals(const Eigen::VectorXd& x) const override;

 private:
  [[nodiscard]] Eigen::VectorXd values_of(const DeviceParameters& device) const;

  std::vector<std::string> keys_;
  Eigen::VectorXd values_;
  Eigen::MatrixXd whitening_;
};

}  // namespace zwidth::internal
