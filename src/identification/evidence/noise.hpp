#pragma once

#include <Eigen/Core>
#include <vector>

namespace zwidth::internal {

/// A filter that makes what is left of a record white: e[k] = sum_j filter[j] r[k - j] / deviation.
struct Noise {
  std::vector<double> filter = {1.0};
  double deviation = 1.0;
};

/// An autoregression of residuals by least squares (Hannan & Deistler 1988, ch. 5), all of one record.
///
/// Motion that a disturbance makes is the device's own response, measurement noise is white: the filter holds both, so that each
/// frequency counts by its noise, drift included. `step`: of the encoder; its rounding, step / sqrt(12), is the least deviation.
[[nodiscard]] Noise noise_of(const std::vector<const Eigen::VectorXd*>& residuals, double step, Eigen::Index order);

/// The filtered rows of columns: as many as they have, less the filter's order.
[[nodiscard]] Eigen::MatrixXd whitened(const Noise& noise, const Eigen::Ref<const Eigen::MatrixXd>& columns);

}  // namespace zwidth::internal
