#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "identification/shot_fit.hpp"
#include "identification/shot_model.hpp"

namespace zwidth::internal {

/// A fit of shots under the noise of its residuals, and its slopes there.
struct DisturbedFit {
  const ShotModel& model;
  const std::vector<Shot>& shots;
  const std::vector<ShotNoise>& noise;
  const ShotFit& fit;
  const ShotSlopes& slopes;
  const std::vector<bool>& estimated;  ///< which of x the data determine
  const std::vector<std::string>& locked;
  double lowest = 0.0;   ///< rad/s, of the excited band
  double highest = 0.0;  ///< rad/s
};

/// How the fit scatters as a disturbing force moves the device itself: a body that a disturbance lets stick later moves on
/// elsewhere, which no sum over one record's residuals shows.
///
///     C = (1/n) sum_i d_i d_i' + (J'J)^-1,   d_i = (J'J)^-1 J' W (y(p, u + w_i) - y(p, u))
///
/// J: W dy/dp with the states eliminated; w_i: white forces, each with both signs, of the size with which the linear
/// device makes the residuals' spectrum in the band (its median, where that stands above the white noise of the position).
/// 0 for what is held or not estimated, and everywhere where no disturbance shows. The same every time.
[[nodiscard]] Eigen::MatrixXd scatter_under_disturbance(const DisturbedFit& of);

}  // namespace zwidth::internal
