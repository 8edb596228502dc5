#include "identification/verdict/line_bands.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>
#include <cstddef>

#include "identification/evidence/difference_slopes.hpp"

namespace zwidth::internal {

double shared_noise(const FrequencyResponse& response) {
  constexpr double least_freedom = 6.0;
  const double freedom = std::max(least_freedom, 2.0 * response.averages - 2.0);
  const double of_size = response.averages > 0.0 ? freedom / (freedom - 2.0) : 1.0;
  return of_size * std::max(1.0, response.line_correlation);
}

SumOfSquares squares_of_bands(const DeviceFamily& family, const ResponseEvidence& evidence,
                              const FrequencyResponse& response, const Eigen::VectorXd& z,
                              const Eigen::MatrixXd& covariance) {
  constexpr Eigen::Index lines_of_band = 8;
  constexpr Eigen::Index most_bands = 24;
  constexpr double least_share = 1e-3;  // a direction that the fit takes up to this tells nothing
  const Eigen::VectorXd x = z.head(covariance.rows());
  const auto errors = evidence.relative_errors(x);
  if (!errors) return {};
  const auto slopes =
      difference_slopes(family, x, *errors, [&](const Eigen::VectorXd& at) { return evidence.relative_errors(at); });
  if (!slopes) return {};
  const Eigen::Index lines = errors->size() / 2;
  const Eigen::Index bands = std::clamp<Eigen::Index>(lines / lines_of_band, 1, most_bands);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(2 * bands);
  Eigen::MatrixXd sums_of_slopes = Eigen::MatrixXd::Zero(2 * bands, x.size());
  for (Eigen::Index i = 0; i < errors->size(); ++i) {
    const Eigen::Index k = i % lines;
    const Eigen::Index band = k * bands / lines;
    const auto begin = (band * lines + bands - 1) / bands;
    const auto end = ((band + 1) * lines + bands - 1) / bands;
    const ResponsePoint& point = response.points[static_cast<std::size_t>(k)];
    const double variance = 0.5 * point.variance / std::norm(point.value) + std::exp(2.0 * z(x.size()));
    const double weight = 1.0 / std::sqrt(variance * static_cast<double>(end - begin));
    const Eigen::Index row = i < lines ? band : bands + band;
    sums(row) += weight * (*errors)(i);
    sums_of_slopes.row(row) += weight * slopes->row(i);
  }
  const Eigen::MatrixXd left =
      Eigen::MatrixXd::Identity(2 * bands, 2 * bands) - sums_of_slopes * covariance * sums_of_slopes.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(left);
  SumOfSquares result;
  for (Eigen::Index i = 0; i < 2 * bands; ++i) {
    const double share = solver.eigenvalues()(i);
    if (share < least_share) continue;
    result.sum += std::pow(solver.eigenvectors().col(i).dot(sums), 2) / share;
    result.freedom += 1.0;
  }
  result.sum /= shared_noise(response);
  return result;
}

Omnibus omnibus_of_lines(const SumOfSquares& squares) {
  Omnibus omnibus;
  if (!(squares.freedom > 0.0) || !std::isfinite(squares.sum)) return omnibus;
  omnibus.p = boost::math::cdf(boost::math::complement(boost::math::chi_squared(squares.freedom), squares.sum));
  return omnibus;
}

}  // namespace zwidth::internal
