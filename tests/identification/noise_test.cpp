#include "identification/evidence/noise.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace zwidth::internal {
namespace {

constexpr Eigen::Index order = 4;

/// White noise with a little of its slow past taken off, as an estimate from it is.
Noise with_means(std::size_t count) { return {{1.0, 0.0, 0.0, 0.0, 0.0}, std::vector<double>(count, -0.4), 1.0}; }

TEST(Noise, OneSampleAtTheBeginningIsOneOfManyInWhatCameBefore) {
  Eigen::VectorXd first = Eigen::VectorXd::Zero(2000);
  first(0) = 1.0;
  EXPECT_LT(whitened(with_means(6), first).squaredNorm(), 0.2);
}

TEST(Noise, ALevelStaysOneFromTheBeginning) {
  const Eigen::MatrixXd white = whitened(with_means(6), Eigen::VectorXd::Constant(2000, 3.0));
  EXPECT_LT((white.array() - white(white.rows() - 1, 0)).abs().maxCoeff(), 1e-9);
}

TEST(Noise, WhiteSamplesStayWhite) {
  std::mt19937 generator(1);
  std::normal_distribution<double> normal;
  Eigen::VectorXd samples(8000);
  for (double& each : samples) each = normal(generator);
  const Noise noise = noise_of({&samples}, 1e-6, order);
  const Eigen::MatrixXd white = whitened(noise, samples);
  EXPECT_NEAR(white.squaredNorm() / static_cast<double>(white.rows()), 1.0, 1e-3);
  EXPECT_NEAR(noise.deviation, samples.norm() / std::sqrt(8000.0), 0.01);
}

}  // namespace
}  // namespace zwidth::internal
