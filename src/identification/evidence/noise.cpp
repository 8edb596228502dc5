#include "identification/evidence/noise.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "identification/model/row_sums.hpp"
#include "linear_systems.hpp"

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
  /// Of all values before each from `first` on.
  [[nodiscard]] const double* before(Eigen::Index first) const { return sums_.data() + reach_ + first; }
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

/// out[k] += sum_j by[j] newest[k - j lag]
void add_lagged(double* out, const double* by, Eigen::Index count, const double* newest, Eigen::Index lag,
                Eigen::Index rows) {
  const Eigen::Index whole = rows / lanes * lanes;
  add_rows(out, by, count, newest, -lag, whole);
  for (Eigen::Index k = whole; k < rows; ++k) {
    for (Eigen::Index j = 0; j < count; ++j) out[k] += by[j] * newest[k - j * lag];
  }
}

/// n 2^m: so long the m-th mean is, and so far back it ends.
Eigen::Index length_of(Eigen::Index order, Eigen::Index m) { return order << m; }

}  // namespace

void whiten(const Noise& noise, Eigen::Ref<Eigen::MatrixXd> columns) {
  const auto order = static_cast<Eigen::Index>(noise.filter.size()) - 1;
  const auto means = static_cast<Eigen::Index>(noise.means.size());
  const Eigen::Index rows = columns.rows() - order;
  std::vector<double> filter = noise.filter;
  for (double& each : filter) each /= noise.deviation;
  PastSums sums(means > 0 ? length_of(order, means) : 0);
  Eigen::VectorXd before;
  for (Eigen::Index column = 0; column < columns.cols(); ++column) {
    before = columns.col(column);
    columns.col(column).setZero();
    double* out = columns.col(column).data() + order;
    add_lagged(out, filter.data(), order + 1, before.data() + order, 1, rows);
    if (means == 0) continue;
    sums.take(before);
    for (Eigen::Index m = 0; m < means; ++m) {
      const Eigen::Index length = length_of(order, m);
      const double by = noise.means[static_cast<std::size_t>(m)] / noise.deviation / static_cast<double>(length);
      const double ends[] = {by, -by};
      add_lagged(out, ends, 2, sums.before(order - length), length, rows);
    }
  }
}

Eigen::MatrixXd whitened(const Noise& noise, const Eigen::Ref<const Eigen::MatrixXd>& columns) {
  Eigen::MatrixXd white = columns;
  whiten(noise, white);
  return white.bottomRows(columns.rows() - static_cast<Eigen::Index>(noise.filter.size()) + 1);
}

Noise noise_of(const std::vector<const Eigen::VectorXd*>& residuals, double step, Eigen::Index order) {
  constexpr Eigen::Index least_repeats = 4;
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
      solve_symmetric(normal.bottomRightCorner(size - 1, size - 1), normal.bottomLeftCorner(size - 1, 1));
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
