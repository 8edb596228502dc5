#include "identification/shot_noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace zwidth::internal {

Eigen::MatrixXd whitened(const ShotNoise& noise, const Eigen::MatrixXd& columns) {
  const auto order = static_cast<Eigen::Index>(noise.filter.size()) - 1;
  const Eigen::Index rows = columns.rows() - order;
  Eigen::MatrixXd white = Eigen::MatrixXd::Zero(rows, columns.cols());
  for (Eigen::Index column = 0; column < columns.cols(); ++column) {
    for (Eigen::Index j = 0; j <= order; ++j) {
      const double weight = noise.filter[static_cast<std::size_t>(j)] / noise.deviation;
      white.col(column) += weight * columns.col(column).segment(order - j, rows);
    }
  }
  return white;
}

std::complex<double> response_of(const ShotNoise& noise, double angle) {
  std::complex<double> sum;
  for (std::size_t j = 0; j < noise.filter.size(); ++j) {
    sum += noise.filter[j] * std::polar(1.0, -angle * static_cast<double>(j));
  }
  return sum / noise.deviation;
}

std::vector<ShotNoise> shot_noise(const std::vector<Shot>& shots, const ShotPositions& residuals,
                                  const std::vector<double>& steps, std::size_t order) {
  std::vector<ShotNoise> noise(steps.size());
  const auto size = static_cast<Eigen::Index>(order);
  for (std::size_t record = 0; record < steps.size(); ++record) {
    Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size + 1, size + 1);
    Eigen::Index rows = 0;
    for (std::size_t i = 0; i < shots.size(); ++i) {
      if (shots[i].record != record) continue;
      const Eigen::VectorXd& r = residuals[i];
      const Eigen::Index count = r.size() - size;
      Eigen::MatrixXd past(count, size + 1);
      for (Eigen::Index j = 0; j <= size; ++j) past.col(j) = r.segment(size - j, count);
      normal += past.transpose() * past;
      rows += count;
    }
    // White noise far below the residuals keeps the filter finite where they are exact.
    constexpr double least = 1e-10;
    normal.diagonal().array() += least * normal(0, 0) + 1e-300;
    const Eigen::VectorXd solution =
        normal.bottomRightCorner(size, size).ldlt().solve(normal.bottomLeftCorner(size, 1));
    ShotNoise& own = noise[record];
    double gain = 1.0;
    for (Eigen::Index j = 0; j < size; ++j) {
      own.filter.push_back(-solution(j));
      gain += solution(j) * solution(j);
    }
    double squares = 0.0;
    own.deviation = 1.0;
    for (std::size_t i = 0; i < shots.size(); ++i) {
      if (shots[i].record == record) squares += whitened(own, residuals[i]).squaredNorm();
    }
    const double rounding = steps[record] * steps[record] / 12.0 * gain;
    own.deviation = std::sqrt(std::max({squares / static_cast<double>(rows), rounding, 1e-300}));
  }
  return noise;
}

}  // namespace zwidth::internal
