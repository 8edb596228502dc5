#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "identification/evidence/time_evidence.hpp"

namespace zwidth::internal {

/// What a fit leaves of a segment, and what might explain it; all filtered by the record's noise, a row per sample.
struct SegmentResiduals {
  std::size_t record = 0;
  std::size_t first = 0;      ///< sample of the record of the first row
  std::size_t period = 0;     ///< samples after which the force repeats; 0: it does not
  Eigen::VectorXd residuals;  ///< of deviation 1
  Eigen::MatrixXd shared;     ///< how they change with the numbers of the fit
  Eigen::MatrixXd own;        ///< how they change with the segment's state
  Eigen::MatrixXd lagged;     ///< the force at the lags of Calibration::force_lags
  Eigen::MatrixXd forces;     ///< what nonlinear forces would add to the position
  /// 1, and 0 where the encoder hardly moves: rounding is no noise there (Widrow & Kollar 2008, ch. 5). All else is 0 there too.
  Eigen::VectorXd counts;
};

/// What the numbers and states z leave of the records; nothing where they cannot be played.
///
/// A force f that the model lacks adds G f to the position, G the fitted linear device: f of the square and cube of the command,
/// sign, size and square of the velocity, square and cube of the position, and a damping that drifts.
[[nodiscard]] std::optional<std::vector<SegmentResiduals>> segment_residuals(const TimeEvidence& evidence,
                                                                             const Eigen::VectorXd& z);

}  // namespace zwidth::internal
