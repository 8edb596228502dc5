#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "identification/model/added_rival.hpp"
#include "identification/model/number.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// The most likely values of all numbers, and what they leave open.
struct BestNumbers {
  std::vector<Number> numbers;
  Eigen::VectorXd x;                ///< their coordinates
  Eigen::MatrixXd covariance;       ///< of x, beliefs beforehand included
  Eigen::VectorXd stiffness_slope;  ///< how log K_CR changes with x; 0 for what is no number of the device
  double stiffness = 0.0;           ///< K_CR, N/m or N m/rad
  Interval interval;                ///< the answer's
  Motion motion = Motion::linear;
};

/// What else explains the records, a row per number, first what moves the limit most.
///
///     log K(x_i) = log K + cov(log K, x_i) / var(x_i) (x_i - best),   all else refitted
///
/// over x_i within 1.96 deviations and its bound, cut to the answer's interval. The gain is (x_i - none)^2 / (2 var(x_i)).
/// No deviation where it is 90 % of what was believed beforehand or more.
[[nodiscard]] std::vector<RivalEstimate> rival_table(const BestNumbers& best, std::span<const AddedRival> rivals);

}  // namespace zwidth::internal
