#include "identification/evidence/noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace zwidth::internal {

Eigen::MatrixXd whitened(const Noise& noise, const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  const auto order = static_cast<Eigen::Index>(noise.filter.size()) - 1;
  const Eigen::Index rows = columns.rows() - order;
  Eigen::MatrixXd white = Eigen::MatrixXd::Zero(rows, columns.cols());
  for (Eigen::Index column = 0; column < columns.cols(); ++column) {
    for (Eigen::Index j = 0; j <= order; ++j) {
      white.col(column) +=
          noise.filter[static_cast<std::size_t>(j)] / noise.deviation * columns.col(column).segment(order - j, rows);
    }
  }
  return white;
}

Noise noise_of(const std::vector<const Eigen::VectorXd*>& residuals, double step, Eigen::Index order) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(order + 1, order + 1);
  Eigen::Index rows = 0;
  for (const Eigen::VectorXd* each : residuals) {
    const Eigen::Index count = each->size() - order;
    Eigen::MatrixXd past(count, order + 1);
    for (Eigen::Index j = 0; j <= order; ++j) past.col(j) = each->segment(order - j, count);
    normal.noalias() += past.transpose() * past;
    rows += count;
  }
  constexpr double least = 1e-10;  // white noise far below keeps the filter finite where the residuals are exact
  normal.diagonal().array() += least * normal(0, 0) + 1e-300;
  const Eigen::VectorXd past = normal.bottomRightCorner(order, order).ldlt().solve(normal.bottomLeftCorner(order, 1));
  Noise noise;
  for (const double each : past) noise.filter.push_back(-each);
  double squares = 0.0;
  for (const Eigen::VectorXd* each : residuals) squares += whitened(noise, *each).squaredNorm();
  const double rounding = step * step / 12.0 * (1.0 + past.squaredNorm());
  noise.deviation = std::sqrt(std::max({squares / static_cast<double>(rows), rounding, 1e-300}));
  return noise;
}

}  // namespace zwidth::internal
