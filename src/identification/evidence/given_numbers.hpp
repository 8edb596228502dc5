#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "identification/evidence/part_of_evidence.hpp"
#include "identification/model/device_family.hpp"
#include "zwidth/model/uncertainty.hpp"

namespace zwidth::internal {

/// What a device file says of its numbers: their values, and the covariance of these. It has no elements of its own.
///
///     cost = (v(x) - v_file)' C^-1 (v(x) - v_file) / 2
class GivenNumbers : public PartOfEvidence {
 public:
  /// Directions that the covariance leaves no width are left out. `file`: a device with every number of `uncertainty`.
  GivenNumbers(const DeviceFamily& family, const DeviceParameters& file, const Uncertainty& uncertainty);

  [[nodiscard]] Eigen::VectorXd own_lowest() const override { return Eigen::VectorXd(0); }
  [[nodiscard]] Eigen::VectorXd own_start(const Eigen::VectorXd& /*x*/) const override { return Eigen::VectorXd(0); }
  [[nodiscard]] std::optional<double> cost(const Eigen::VectorXd& x, const Eigen::VectorXd& own) const override;
  [[nodiscard]] bool add_picture(const Eigen::VectorXd& x, const Eigen::VectorXd& own, Eigen::Index at,
                                 Picture& sum) const override;

 private:
  [[nodiscard]] Eigen::VectorXd values_of(const DeviceParameters& device) const;
  [[nodiscard]] std::optional<Eigen::VectorXd> residuals(const Eigen::VectorXd& x) const;

  const DeviceFamily& family_;
  std::vector<std::string> keys_;
  Eigen::VectorXd values_;
  Eigen::MatrixXd whitening_;
};

}  // namespace zwidth::internal
