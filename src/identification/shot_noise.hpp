#pragma once

#include <Eigen/Core>
#include <complex>
#include <cstddef>
#include <vector>

#include "identification/shot_model.hpp"

namespace zwidth::internal {

/// What is left of a record's positions, as a filter that makes it white: e[k] = sum_j filter[j] r[k - j] / deviation.
struct ShotNoise {
  std::vector<double> filter = {1.0};
  double deviation = 1.0;
};

/// An autoregression of the residuals of all shots of each record, by least squares (Hannan & Deistler 1988, ch. 5).
///
/// Motion that a disturbance makes is the device's own response, measurement noise is white: the filter holds both, so
/// that the fit weighs each frequency by its noise, drift included. The deviation is that of the filtered residuals, at
/// least that of an encoder's rounding, step / sqrt(12), through the filter.
[[nodiscard]] std::vector<ShotNoise> shot_noise(const std::vector<Shot>& shots, const ShotPositions& residuals,
                                                const std::vector<double>& steps, std::size_t order);

/// The filtered rows of a shot: as many as it has samples, less the filter's order.
[[nodiscard]] Eigen::MatrixXd whitened(const ShotNoise& noise, const Eigen::MatrixXd& columns);

/// The filter's, at an `angle` of w T, rad: sum_j filter[j] e^{-j angle j} / deviation.
[[nodiscard]] std::complex<double> response_of(const ShotNoise& noise, double angle);

}  // namespace zwidth::internal
