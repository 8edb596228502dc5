#pragma once

#include <vector>

#include "identification/evidence/part_of_evidence.hpp"
#include "identification/model/device_family.hpp"
#include "zwidth/identification/measured_limit.hpp"

namespace zwidth::internal {

/// Walls at which the device began to oscillate. It has no elements of its own.
///
///     r = log(K_c / K) / s_K,    log(w_c / (2 pi f)) / s_f
///
/// of the crossover (K_c, w_c), with the wall's B closed, at which poles leave the unit circle: the one nearest to f, or the one
/// that limits where no f was measured. It cannot be computed where a device has no such crossover.
class LimitEvidence : public PartOfEvidence {
 public:
  /// Requires limits without a find_problem().
  LimitEvidence(const DeviceFamily& family, std::vector<MeasuredLimit> limits);

  [[nodiscard]] Eigen::VectorXd own_lowest() const override { return Eigen::VectorXd(0); }
  [[nodiscard]] Eigen::VectorXd own_start(const Eigen::VectorXd& /*x*/) const override { return Eigen::VectorXd(0); }
  [[nodiscard]] std::optional<double> cost(const Eigen::VectorXd& x, const Eigen::VectorXd& own) const override;
  [[nodiscard]] bool add_picture(const Eigen::VectorXd& x, const Eigen::VectorXd& own, Eigen::Index at,
                                 Picture& sum) const override;

  [[nodiscard]] std::optional<Eigen::VectorXd> residuals(const Eigen::VectorXd& x) const;

 private:
  const DeviceFamily& family_;
  std::vector<MeasuredLimit> limits_;
};

}  // namespace zwidth::internal
