#pragma once

#include <vector>

#include "identification/evidence/squares_of_numbers.hpp"
#include "zwidth/identification/measured_limit.hpp"

namespace zwidth::internal {

/// Walls at which the device began to oscillate.
///
///     r = log(K_c / K) / s_K,    log(w_c / (2 pi f)) / s_f
///
/// of the crossover (K_c, w_c), with the wall's B closed, at which poles leave the unit circle: the one nearest to f, or the one
/// that limits where no f was measured. It cannot be computed where a device has no such crossover.
class LimitEvidence : public SquaresOfNumbers {
 public:
  /// Requires limits without a find_problem().
  LimitEvidence(const DeviceFamily& family, std::vector<MeasuredLimit> limits);

  [[nodiscard]] std::optional<Eigen::VectorXd> residuals(const Eigen::VectorXd& x) const override;

 private:
  std::vector<MeasuredLimit> limits_;
};

}  // namespace zwidth::internal
