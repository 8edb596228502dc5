#include "identification/inverse_dynamics/correlated_residuals.hpp"

#include <algorithm>
#include <cmath>

#include "linear_systems.hpp"

namespace zwidth::internal {
namespace {

/// First-order autocorrelation of each column.
Eigen::RowVectorXd first_autocorrelation(const Eigen::MatrixXd& scores) {
  const Eigen::Index pairs = scores.rows() - 1;
  Eigen::RowVectorXd rho(scores.cols());
  for (Eigen::Index j = 0; j < scores.cols(); ++j) {
    const auto before = scores.col(j).head(pairs);
    const double energy = before.squaredNorm();
    // A unit root would ask for all lags.
    rho(j) = energy > 0.0 ? std::clamp(scores.col(j).tail(pairs).dot(before) / energy, -0.97, 0.97) : 0.0;
  }
  return rho;
}

/// Lags that count, as if each column were a first-order autoregression; the most that one column asks for.
Eigen::Index bartlett_lags(const Eigen::MatrixXd& scores) {
  const auto n = static_cast<double>(scores.rows());
  double most = 0.0;
  for (const double rho : first_autocorrelation(scores)) {
    const double curvature = 4.0 * rho * rho / std::pow(1.0 - rho * rho, 2.0);
    most = std::max(most, std::ceil(1.1447 * std::cbrt(curvature * n)));
  }
  return static_cast<Eigen::Index>(std::min(most, n / 4.0));
}

/// n times the long-run covariance of the columns' means: the sum of all lagged covariances, Bartlett's weights.
Eigen::MatrixXd lagged_sum(const Eigen::MatrixXd& scores, Eigen::Index lags) {
  Eigen::MatrixXd sum = scores.transpose() * scores;
  for (Eigen::Index lag = 1; lag <= lags; ++lag) {
    const double weight = 1.0 - static_cast<double>(lag) / static_cast<double>(lags + 1);
    const Eigen::Index rows = scores.rows() - lag;
    const Eigen::MatrixXd shifted = scores.bottomRows(rows).transpose() * scores.topRows(rows);
    sum += weight * (shifted + shifted.transpose());
  }
  return sum;
}

}  // namespace

Eigen::MatrixXd covariance_with_correlated_residuals(const Eigen::MatrixXd& regressors,
                                                     const Eigen::VectorXd& residuals) {
  const Eigen::Index n = regressors.rows();
  const Eigen::Index p = regressors.cols();
  const Eigen::MatrixXd inverse = inverse_of_squares(regressors);
  const Eigen::MatrixXd scores = residuals.asDiagonal() * regressors;
  const Eigen::MatrixXd middle = lagged_sum(scores, bartlett_lags(scores));
  const double freedom = static_cast<double>(n) / static_cast<double>(n - p);
  Eigen::MatrixXd covariance = freedom * inverse * middle * inverse;
  const Eigen::MatrixXd classical = residuals.squaredNorm() / static_cast<double>(n - p) * inverse;
  for (Eigen::Index j = 0; j < p; ++j) {
    const double ratio = classical(j, j) / covariance(j, j);
    if (!(ratio > 1.0)) continue;
    covariance.row(j) *= std::sqrt(ratio);
    covariance.col(j) *= std::sqrt(ratio);
  }
  return covariance;
}

}  // namespace zwidth::internal
