#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "identification/verdict/segment_residuals.hpp"
#include "zwidth/identification/measured_stiffness.hpp"

namespace zwidth::internal {

/// How the limit hangs on the numbers of a fit.
struct LimitSlope {
  Eigen::VectorXd slope;      ///< of log K_CR by the numbers' coordinates
  Eigen::VectorXd precision;  ///< of what was believed of them beforehand: 1 / deviation^2
};

/// By what factor, at least 1, the limit is less certain than white residuals would leave it.
///
///     d log K = sum_k w_k r_k,    w = J H^{-1} g
///
/// The variance of that sum is taken of its parts as they are (sandwich: Huber 1967, White 1982): parts of the record, one where
/// its force repeats, and parts of its spectrum, each of as much weight. Motion that the model lacks is large in some of either.
/// The larger of both over sum w_k^2 counts.
[[nodiscard]] double widening(const std::vector<SegmentResiduals>& segments, const LimitSlope& limit);

/// Logarithms of a limit and of what leaves it open.
struct OpenLimit {
  double best = 0.0;       ///< of the most likely K_CR
  double lower = 0.0;      ///< end of the profile
  double upper = 0.0;      ///< the other
  double deviation = 0.0;  ///< of log K_CR: sqrt(g'C g), g its slope, C the covariance of the numbers
};

/// The answer's interval: each half of the profile's, at least 1.96 deviations, times the widening.
///
/// Noise that no filter of a record's length tells, and ends that the search of a profile does not reach: the profiles alone of
/// 124 simulated records missed their truth in 32 %, such intervals in 12 %, looked at before Calibration::more_than_noise.
[[nodiscard]] Interval widened(const OpenLimit& limit, double by);

/// The range of a found limit; nothing where the data say next to nothing of it.
[[nodiscard]] std::optional<Interval> told_limit(const Interval& interval);

}  // namespace zwidth::internal
