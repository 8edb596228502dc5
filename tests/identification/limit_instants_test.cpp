#include "identification/verdict/limit_instants.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace zwidth::internal {
namespace {

/// log K = log(1 + d (instant - 1/2)) - c (instant of the delay - 1/2), d and c known to a deviation.
std::optional<DriftInstants> instants_of(double drift, double deviation, double of_delay, double deviation_of_delay) {
  Minimum minimum{Eigen::Vector2d(drift, of_delay), {}, true};
  minimum.picture.hessian =
      Eigen::Vector2d(1.0 / (deviation * deviation), 1.0 / (deviation_of_delay * deviation_of_delay)).asDiagonal();
  const auto log_limit = [](const Eigen::VectorXd& z, const DriftInstants& at) -> std::optional<double> {
    const double left = 1.0 + z(0) * (at.damping - 0.5);
    return left > 0.0 ? std::optional(std::log(left) - z(1) * (at.delay - 0.5)) : std::nullopt;
  };
  return limit_instants(log_limit, minimum, 0, 2);
}

std::optional<double> instant_of(double drift, double deviation) {
  const auto instants = instants_of(drift, deviation, 0.0, 0.01);
  return instants ? std::optional(instants->damping) : std::nullopt;
}

TEST(LimitInstants, IsTheSofterEndOfAClearDrift) {
  EXPECT_GT(*instant_of(-0.4, 0.01), 0.99);  // damping falls: the end
  EXPECT_LT(*instant_of(0.4, 0.01), 0.01);   // damping rises: the beginning
}

TEST(LimitInstants, IsTheMiddleWhereTheDriftMayBeChance) {
  EXPECT_DOUBLE_EQ(*instant_of(-0.02, 0.012), 0.5);
  EXPECT_DOUBLE_EQ(*instant_of(0.0, 0.01), 0.5);
  // three deviations: 1 - 3.84 / 9 of the way
  EXPECT_NEAR(*instant_of(-0.003, 0.001), 0.5 + 0.5 * (1.0 - 3.84 / 9.0), 2e-3);
}

// A delay that may shorten by chance, which would stiffen the end, hid a damping that falls.
TEST(LimitInstants, OfEachDriftByItself) {
  const auto chance = instants_of(-0.46, 0.03, -0.3, 0.2);
  EXPECT_GT(chance->damping, 0.98);
  EXPECT_DOUBLE_EQ(chance->delay, 0.5);
  const auto clear = instants_of(-0.46, 0.03, -0.3, 0.01);
  EXPECT_GT(clear->damping, 0.98);
  EXPECT_LT(clear->delay, 0.01);
}

TEST(LimitInstants, IsNoneWithoutALimit) { EXPECT_FALSE(instant_of(-3.0, 0.1)); }

}  // namespace
}  // namespace zwidth::internal
