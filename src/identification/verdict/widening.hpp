#pragma once

#include <Eigen/Core>
#include <vector>

#include "identification/verdict/left_over.hpp"

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
[[nodiscard]] double widening(const std::vector<LeftOver>& left, const LimitSlope& limit);

}  // namespace zwidth::internal
