#include "identification/verdict/widening.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <span>

#include "identification/verdict/calibration.hpp"
#include "identification/verdict/confidence.hpp"
#include "linear_systems.hpp"
#include "signal/fourier.hpp"

namespace zwidth::internal {
namespace {

/// Weights of the residuals in the limit, by segment.
std::vector<Eigen::VectorXd> weights_of(const std::vector<SegmentResiduals>& segments, const Eigen::VectorXd& slope,
                                        const Eigen::MatrixXd& hessian) {
  const Eigen::VectorXd direction = solve_symmetric(hessian, slope);
  std::vector<Eigen::VectorXd> weights;
  for (const SegmentResiduals& each : segments) {
    const Eigen::VectorXd moved = each.shared * direction;
    weights.emplace_back(moved - each.own * least_squares(each.own, moved));
  }
  return weights;
}

/// J'J with each segment's state refitted, and what was believed.
Eigen::MatrixXd hessian_of(const std::vector<SegmentResiduals>& segments, const Eigen::VectorXd& precision) {
  Eigen::MatrixXd hessian = precision.asDiagonal();
  for (const SegmentResiduals& each : segments) {
    const Eigen::MatrixXd rest = each.shared - each.own * least_squares_of_columns(each.own, each.shared);
    hessian.selfadjointView<Eigen::Lower>().rankUpdate(rest.transpose());
  }
  hessian.triangularView<Eigen::StrictlyUpper>() = hessian.transpose();
  return hessian;
}

/// Terms of a sum, in an order in which neighbours belong together.
struct Terms {
  std::vector<double> values;
  std::vector<double> weights;  ///< their variances, were the residuals white
};

/// The sum of squares of the sums over parts of equal weight.
double variance_of(const Terms& terms) {
  double all = 0.0;
  for (const double each : terms.weights) all += each;
  double variance = 0.0;
  double sum = 0.0;
  double until = 0.0;
  int part = 1;
  for (std::size_t k = 0; k < terms.values.size(); ++k) {
    sum += terms.values[k];
    until += terms.weights[k];
    if (until < all * part / Calibration::parts_of_limit && k + 1 < terms.values.size()) continue;
    variance += sum * sum;
    sum = 0.0;
    while (part < Calibration::parts_of_limit && until >= all * part / Calibration::parts_of_limit) ++part;
  }
  return variance;
}

/// By time, samples of a repeated force at one phase as one.
Terms by_time(const SegmentResiduals& segment, const Eigen::VectorXd& weights) {
  const auto rows = static_cast<std::size_t>(weights.size());
  const std::size_t length = segment.period == 0 ? rows : std::min(rows, segment.period);
  Terms terms{std::vector<double>(length, 0.0), std::vector<double>(length, 0.0)};
  for (std::size_t k = 0; k < rows; ++k) {
    const double weight = weights(static_cast<Eigen::Index>(k));
    terms.values[k % length] += weight * segment.residuals(static_cast<Eigen::Index>(k));
    terms.weights[k % length] += weight * weight;
  }
  return terms;
}

/// By frequency (Parseval).
Terms by_frequency(const SegmentResiduals& segment, const Eigen::VectorXd& weights) {
  const auto of = [](const Eigen::VectorXd& samples) {
    return spectrum(std::span<const double>(samples.data(), static_cast<std::size_t>(samples.size())));
  };
  const auto weight = of(weights);
  const auto residual = of(segment.residuals);
  const double scale = 1.0 / static_cast<double>(weights.size());
  const bool is_even = weights.size() % 2 == 0;
  Terms terms;
  for (std::size_t k = 0; k < weight.size(); ++k) {
    const double times = k == 0 || (is_even && k + 1 == weight.size()) ? scale : 2.0 * scale;
    terms.values.push_back(times * (std::conj(weight[k]) * residual[k]).real());
    terms.weights.push_back(times * std::norm(weight[k]));
  }
  return terms;
}

}  // namespace

double widening(const std::vector<SegmentResiduals>& segments, const LimitSlope& limit) {
  if (segments.empty() || limit.slope.squaredNorm() == 0.0) return 1.0;
  const Eigen::MatrixXd hessian = hessian_of(segments, limit.precision);
  const std::vector<Eigen::VectorXd> weights = weights_of(segments, limit.slope, hessian);
  double white = 0.0;
  double of_time = 0.0;
  double of_frequency = 0.0;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    if (weights[i].size() == 0) continue;
    white += weights[i].squaredNorm();
    of_time += variance_of(by_time(segments[i], weights[i]));
    of_frequency += variance_of(by_frequency(segments[i], weights[i]));
  }
  const Eigen::VectorXd direction = solve_symmetric(hessian, limit.slope);
  const double believed = direction.cwiseAbs2().dot(limit.precision);
  const double ratio = (std::max(of_time, of_frequency) + believed) / (white + believed);
  return std::isfinite(ratio) ? std::sqrt(std::max(1.0, ratio)) : 1.0;
}

Interval widened(const OpenLimit& limit, double by) {
  const double least = deviations_of_95 * limit.deviation;
  by *= Calibration::more_than_noise;
  const double down = by * std::max(limit.best - limit.lower, least);
  const double up = by * std::max(limit.upper - limit.best, least);
  return {std::exp(limit.best - down), std::exp(limit.best + up)};
}

std::optional<Interval> told_limit(const Interval& interval) {
  constexpr double widest = 1000.0;
  const bool is_told = interval.lower > 0.0 && interval.upper <= widest * interval.lower;
  return is_told ? std::optional(interval) : std::nullopt;
}

}  // namespace zwidth::internal
