#include "identification/shot_covariance.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace zwidth::internal {
namespace {

/// Two dampings that nearly make up for each other, as two bodies' do: the second is held at 0, the first has settled
/// without it.
ShotSlopes slopes_beside_one_held(double truth) {
  constexpr Eigen::Index rows = 400;
  ShotSlopes slopes;
  Eigen::MatrixXd columns(rows, 2);
  Eigen::VectorXd noise(rows);
  for (Eigen::Index k = 0; k < rows; ++k) {
    const auto t = static_cast<double>(k);
    columns(k, 0) = 100.0 * std::sin(0.1 * t);
    columns(k, 1) = columns(k, 0) + std::sin(0.37 * t);
    noise(k) = std::sqrt(2.0) * std::cos(1.7 * t);
  }
  const Eigen::VectorXd left = noise - columns.col(1) * truth;  // played less recorded
  const double first = columns.col(0).dot(left) / columns.col(0).squaredNorm();
  slopes.residuals.emplace_back(left - columns.col(0) * first);
  slopes.of_parameters.push_back(columns);
  slopes.of_states.push_back(Eigen::VectorXd::Ones(rows));
  return slopes;
}

TEST(ShotCovariance, WhatIsHeldPullsByWhatTheOthersDoNotFollow) {
  const ShotCovariance pulled = shot_covariance(slopes_beside_one_held(1.0), {false, true});
  EXPECT_GT(pulled.pull(1), 10.0);  // sum of sin^2 over 400 samples: 14 deviations
  EXPECT_EQ(pulled.pull(0), 0.0);
  const ShotCovariance calm = shot_covariance(slopes_beside_one_held(0.0), {false, true});
  EXPECT_LT(std::abs(calm.pull(1)), 3.0);
  EXPECT_LT(shot_covariance(slopes_beside_one_held(-1.0), {false, true}).pull(1), -10.0);
}

// Of two dampings of which only the sum shows, each is as open as it was before; their sum is known.
TEST(ShotCovariance, OfASumEachPartStaysOpen) {
  ShotSlopes slopes = slopes_beside_one_held(0.0);
  slopes.of_parameters.front().col(1) = slopes.of_parameters.front().col(0);
  const ShotCovariance found = shot_covariance(slopes, {false, false});
  ASSERT_EQ(found.known.combinations.size(), 1u);
  const Eigen::MatrixXd& c = found.covariance;
  const double of_sum = c(0, 0) + c(1, 1) + 2.0 * c(0, 1);
  EXPECT_GT(std::sqrt(c(0, 0)), 2.0);
  EXPECT_GT(std::sqrt(c(1, 1)), 2.0);
  EXPECT_LT(std::sqrt(of_sum), 0.01);
}

}  // namespace
}  // namespace zwidth::internal
