#include "identification/verdict/limit_instant.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace zwidth::internal {
namespace {

/// log K = log(1 + d (instant - 1/2)), d known to a deviation.
std::optional<double> instant_of(double drift, double deviation) {
  Minimum minimum{Eigen::VectorXd::Constant(1, drift), {}, true};
  minimum.picture.hessian = Eigen::MatrixXd::Constant(1, 1, 1.0 / (deviation * deviation));
  const auto log_limit = [](const Eigen::VectorXd& z, double instant) -> std::optional<double> {
    const double left = 1.0 + z(0) * (instant - 0.5);
    return left > 0.0 ? std::optional(std::log(left)) : std::nullopt;
  };
  return limit_instant(log_limit, minimum, 0, 1);
}

TEST(LimitInstant, IsTheSofterEndOfAClearDrift) {
  EXPECT_GT(*instant_of(-0.4, 0.01), 0.99);  // damping falls: the end
  EXPECT_LT(*instant_of(0.4, 0.01), 0.01);   // damping rises: the beginning
}

TEST(LimitInstant, IsTheMiddleWhereTheDriftMayBeChance) {
  EXPECT_DOUBLE_EQ(*instant_of(-0.02, 0.012), 0.5);
  EXPECT_DOUBLE_EQ(*instant_of(0.0, 0.01), 0.5);
  // three deviations: 1 - 3.84 / 9 of the way
  EXPECT_NEAR(*instant_of(-0.003, 0.001), 0.5 + 0.5 * (1.0 - 3.84 / 9.0), 2e-3);
}

TEST(LimitInstant, IsNoneWithoutALimit) { EXPECT_FALSE(instant_of(-3.0, 0.1)); }

}  // namespace
}  // namespace zwidth::internal
