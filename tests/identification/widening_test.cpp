#include "identification/verdict/widening.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "identification/verdict/calibration.hpp"

namespace zwidth::internal {
namespace {

constexpr Eigen::Index rows = 4000;

/// A number that every sample tells alike, under residuals of deviation 1.
std::vector<SegmentResiduals> left_of(const std::function<double(Eigen::Index)>& residual, std::size_t period = 0) {
  SegmentResiduals left;
  left.period = period;
  left.residuals = Eigen::VectorXd(rows);
  left.shared = Eigen::MatrixXd(rows, 1);
  left.own = Eigen::MatrixXd::Zero(rows, 1);
  for (Eigen::Index k = 0; k < rows; ++k) {
    left.residuals(k) = residual(k);
    left.shared(k, 0) = std::sin(0.05 * static_cast<double>(k));
    left.own(k, 0) = 1.0;
  }
  left.counts = Eigen::VectorXd::Ones(rows);
  return {left};
}

LimitSlope slope(double precision) {
  return {Eigen::VectorXd::Constant(1, 1.0), Eigen::VectorXd::Constant(1, precision)};
}

TEST(Widening, IsNextToOneOfWhiteResiduals) {
  double mean = 0.0;
  constexpr unsigned seeds = 20;
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const double by = widening(left_of([&](Eigen::Index) { return normal(random); }), slope(0.0));
    EXPECT_GE(by, 1.0) << seed;
    EXPECT_LT(by, 1.8) << seed;
    mean += by / seeds;
  }
  EXPECT_LT(mean, 1.3);
}

/// The residual of a damping that was less in the record's first half: it follows the motion there, against it later.
TEST(Widening, GrowsWithMotionThatIsNotExplained) {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto changing = [&](double by) {
    return left_of([&random, &normal, by](Eigen::Index k) {
      const double sign = k < rows / 2 ? 1.0 : -1.0;
      return normal(random) + by * sign * std::sin(0.05 * static_cast<double>(k));
    });
  };
  // 16 parts of rows / 16 samples, each with by^2 (rows / 16)^2 / 4 beside rows / 16 / 2.
  const double ratio = 0.5 * 0.5 * static_cast<double>(rows) / 16.0 / 2.0 + 1.0;
  EXPECT_NEAR(widening(changing(0.5), slope(0.0)), std::sqrt(ratio), 0.3 * std::sqrt(ratio));
  // What is believed beforehand is not open to the residual.
  EXPECT_LT(widening(changing(0.5), slope(1e6)), 1.1);
}

TEST(Widening, AResidualThatRepeatsCountsOnce) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  const Eigen::Index length = 400;
  std::vector<double> once(static_cast<std::size_t>(length));
  for (double& each : once) each = normal(random);
  std::vector<SegmentResiduals> left = left_of(
      [&](Eigen::Index k) { return once[static_cast<std::size_t>(k % length)]; }, static_cast<std::size_t>(length));
  for (Eigen::Index k = 0; k < rows; ++k)
    left[0].shared(k, 0) = std::sin(2.0 * std::numbers::pi * 7.0 * static_cast<double>(k) / length);
  // Ten periods are worth one: about sqrt(10).
  EXPECT_GT(widening(left, slope(0.0)), 2.0);
}

TEST(Widening, AnEndIsAtLeastAsFarAsTheDeviation) {
  const OpenLimit limit{.best = 2.0, .lower = 1.9, .upper = 2.0, .deviation = 0.02};
  const Interval interval = widened(limit, 1.5);
  EXPECT_DOUBLE_EQ(interval.lower, std::exp(2.0 - Calibration::more_than_noise * 0.15));
  EXPECT_DOUBLE_EQ(interval.upper, std::exp(2.0 + Calibration::more_than_noise * 1.5 * 1.96 * 0.02));
}

}  // namespace
}  // namespace zwidth::internal
