#include "identification/evidence/noise.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace zwidth::internal {
namespace {

/// PastSums of a column, its first value before it as often as the longest mean reaches back.
class PastSums {
 public:
  explicit PastSums(Eigen::Index reach) : reach_(reach) {}

  void take(const Eigen::Ref<const Eigen::VectorXd>& column) {
    sums_.assign(1, 0.0);
    sums_.reserve(static_cast<std::size_t>(reach_ + column.size() + 1));
    for (Eigen::Index k = 0; k < reach_; ++k) sums_.push_back(sums_.back() + column(0));
    for (const double each : column) sums_.push_back(sums_.back() + each);
  }
  /// The mean of the `length` values that end `lag` before each of `rows` values from `first` on.
  [[nodiscard]] auto means(Eigen::Index first, Eigen::Index rows, Eigen::Index lag, Eigen::Index length) const {
    const Eigen::Map<const Eigen::VectorXd> sums(sums_.data(), static_cast<Eigen::Index>(sums_.size()));
    const Eigen::Index end = reach_ + first - lag + 1;
    return (sums.segment(end, rows) - sums.segment(end - length, rows)) / static_cast<double>(length);
  }

 private:
  Eigen::Index reach_;
  std::vector<double> sums_;
};

/// n 2^m: so long the m-th mean is, and so far back it ends.
Eigen::Index length_of(Eigen::Index order, Eigen::Index m) { return order << m; }

}  // namespace

Eigen::MatrixXd whitened(const Noise& noise, const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  const auto order = static_cast<Eigen::Index>(noise.filter.size()) - 1;
  const auto means = static_cast<Eigen::Index>(noise.means.size());
  const Eigen::Index rows = columns.rows() - order;
  Eigen::MatrixXd white(rows, columns.cols());
  PastSums sums(means > 0 ? length_of(order, means) : 0);
  for (Eigen::Index column = 0; column < columns.cols(); ++column) {
    auto out = white.col(column);
    out = noise.filter[0] / noise.deviation * columns.col(column).tail(rows);
    for (Eigen::Index j = 1; j <= order; ++j) {
      out += noise.filter[static_cast<std::size_t>(j)] / noise.deviation * columns.col(column).segment(order - j, rows);
    }
    if (means == 0) continue;
    sums.take(columns.col(column));
    for (Eigen::Index m = 0; m < means; ++m) {
      const Eigen::Index length = length_of(order, m);
      out += noise.means[static_cast<std::size_t>(m)] / noise.deviation * sums.means(order, rows, length + 1, length);
    }
  }
  return white;
}

Noise noise_of(const std::vector<const Eigen::VectorXd*>& residuals, double step, Eigen::Index order) {
  constexpr Eigen::Index least_repeats = 12;
  Eigen::Index shortest = residuals.front()->size();
  for (const Eigen::VectorXd* each : residuals) shortest = std::min(shortest, each->size());
  Eigen::Index means = 0;
  while (order > 0 && least_repeats * length_of(order, means + 1) <= shortest) ++means;
  const Eigen::Index size = 1 + order + means;
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(size, size);
  Eigen::Index rows = 0;
  PastSums sums(means > 0 ? length_of(order, means) : 0);
  for (const Eigen::VectorXd* each : residuals) {
    const Eigen::Index count = each->size() - order;
    Eigen::MatrixXd past(count, size);
    for (Eigen::Index j = 0; j <= order; ++j) past.col(j) = each->segment(order - j, count);
    if (means > 0) sums.take(*each);
    for (Eigen::Index m = 0; m < means; ++m) {
      past.col(1 + order + m) = sums.means(order, count, length_of(order, m) + 1, length_of(order, m));
    }
    normal.noalias() += past.transpose() * past;
    rows += count;
  }
  constexpr double least = 1e-10;  // white noise far below keeps the filter finite where the residuals are exact
  for (Eigen::Index i = 0; i < size; ++i) {
    const double terms = i > order ? static_cast<double>(length_of(order, i - order - 1)) : 1.0;
    normal(i, i) += least / terms * normal(0, 0) + 1e-300;
  }
  const Eigen::VectorXd past =
      normal.bottomRightCorner(size - 1, size - 1).ldlt().solve(normal.bottomLeftCorner(size - 1, 1));
  Noise noise;
  double gain = 1.0;  // of white noise
  for (Eigen::Index i = 0; i < size - 1; ++i) {
    (i < order ? noise.filter : noise.means).push_back(-past(i));
    gain += past(i) * past(i) / (i < order ? 1.0 : static_cast<double>(length_of(order, i - order)));
  }
  double squares = 0.0;
  for (const Eigen::VectorXd* each : residuals) squares += whitened(noise, *each).squaredNorm();
  const double rounding = step * step / 12.0 * gain;
  noise.deviation = std::sqrt(std::max({squares / static_cast<double>(rows), rounding, 1e-300}));
  return noise;
}

}  // namespace zwidth::internal
