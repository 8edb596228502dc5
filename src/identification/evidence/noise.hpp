#pragma once

#include <Eigen/Core>
#include <vector>

namespace zwidth::internal {

/// A filter that makes what is left of a record white:
///
///     e[k] = (sum_j filter[j] r[k - j] + sum_m means[m] mean(r[k - 2 n], ..., r[k - n - 1]) ) / deviation,   n = order 2^m
///
/// order: that of `filter`. Before the first sample r is as there.
struct Noise {
  std::vector<double> filter = {1.0};
  std::vector<double> means = {};  ///< of the past, each twice as long and as far as the one before
  double deviation = 1.0;
};

/// An autoregression of residuals by least squares, all of one record: its own `order` last values, and means of those before,
/// up to a quarter of the shortest of `residuals` (Corsi 2009, whose means tell slow noise with few numbers).
///
/// Motion that a disturbance makes is the device's own response, measurement noise is white: the filter holds both, so that each
/// frequency counts by its noise, drift included. `step`: of the encoder; its rounding, step / sqrt(12), is the least deviation.
[[nodiscard]] Noise noise_of(const std::vector<const Eigen::VectorXd*>& residuals, double step, Eigen::Index order);

/// Filters columns in place: of as many rows as the filter's order, the first ones, 0 is left.
void whiten(const Noise& noise, Eigen::Ref<Eigen::MatrixXd> columns);

/// The filtered rows of columns: as many as they have, less the filter's order.
[[nodiscard]] Eigen::MatrixXd whitened(const Noise& noise, const Eigen::Ref<const Eigen::MatrixXd>& columns);

}  // namespace zwidth::internal
