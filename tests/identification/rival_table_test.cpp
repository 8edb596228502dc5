#include "identification/verdict/rival_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace zwidth::internal {
namespace {

/// A damping that carries the limit, a friction and a dead band beside it.
BestNumbers fitted_numbers() {
  using Scale = Number::Scale;
  BestNumbers best;
  best.numbers = {{.key = "body.motor.damping", .unit = 2.0},
                  {"friction.motor", Scale::not_negative, 5.0, 0.0, 0.1},
                  {"dead_band", Scale::not_negative, 5.0, 0.0, 0.05}};
  best.x = Eigen::Vector3d(1.0, 0.02, 0.0);
  // Friction passes for damping: correlation -0.8; the dead band is what was believed of it.
  best.covariance = Eigen::Matrix3d::Zero();
  best.covariance(0, 0) = 0.01;
  best.covariance(1, 1) = 0.0001;
  best.covariance(0, 1) = best.covariance(1, 0) = -0.0008;
  best.covariance(2, 2) = 0.0024;
  best.stiffness_slope = Eigen::Vector3d(1.0, 0.0, 0.0);
  best.stiffness = 100.0;
  best.interval = {80.0, 110.0};
  return best;
}

const std::vector<AddedRival> added = {{"drive_dead_band", {"dead_band"}}, {"coulomb_friction", {"friction.motor"}}};

TEST(RivalTable, GivesSizeDeviationGainAndWhatTheLimitIsWithIt) {
  const std::vector<RivalEstimate> table = rival_table(fitted_numbers(), added);
  ASSERT_EQ(table.size(), 2U);
  const RivalEstimate& friction = table[0];
  EXPECT_EQ(friction.code, "coulomb_friction");
  EXPECT_EQ(friction.parameter, "friction.motor");
  EXPECT_EQ(friction.unit, "N");
  EXPECT_DOUBLE_EQ(friction.value, 0.1);
  ASSERT_TRUE(friction.standard_deviation);
  EXPECT_DOUBLE_EQ(*friction.standard_deviation, 0.05);
  EXPECT_DOUBLE_EQ(friction.log_likelihood_gain, 2.0);
  // d log K / d x = -0.0008 / 0.0001 = -8, from 1.96 deviations down to 1.96 up.
  ASSERT_TRUE(friction.stiffness_interval);
  EXPECT_NEAR(friction.stiffness_interval->lower, 100.0 * std::exp(-8.0 * 0.0196), 1e-9);
  EXPECT_DOUBLE_EQ(friction.stiffness_interval->upper, 110.0);  // the answer's end
  EXPECT_EQ(table[1].code, "drive_dead_band");
  EXPECT_FALSE(table[1].standard_deviation);
  EXPECT_EQ(table[1].log_likelihood_gain, 0.0);
}

TEST(RivalTable, ANumberIsCutAtItsBound) {
  BestNumbers best = fitted_numbers();
  best.interval = {10.0, 1000.0};
  best.x(1) = 0.005;
  const std::vector<RivalEstimate> table = rival_table(best, added);
  ASSERT_TRUE(table[0].stiffness_interval);
  EXPECT_NEAR(table[0].stiffness_interval->upper, 100.0 * std::exp(8.0 * 0.005), 1e-9);
}

TEST(RivalTable, StaysFiniteWhereANumberIsExact) {
  BestNumbers best = fitted_numbers();
  best.covariance.row(1).setZero();
  best.covariance.col(1).setZero();
  for (const RivalEstimate& each : rival_table(best, added)) {
    EXPECT_TRUE(std::isfinite(each.log_likelihood_gain)) << each.code;
    ASSERT_TRUE(each.stiffness_interval) << each.code;
    EXPECT_GE(each.stiffness_interval->lower, best.interval.lower) << each.code;
    EXPECT_LE(each.stiffness_interval->upper, best.interval.upper) << each.code;
  }
}

TEST(RivalTable, UnitsAreThoseOfTheMotion) {
  EXPECT_EQ(unit_of(RivalMeasure::quadratic_damping, Motion::linear), "N s2/m2");
  EXPECT_EQ(unit_of(RivalMeasure::quadratic_damping, Motion::rotary), "N m s2/rad2");
  EXPECT_EQ(unit_of(RivalMeasure::stiffness, Motion::rotary), "N m/rad");
  EXPECT_EQ(unit_of(RivalMeasure::time, Motion::linear), "s");
}

}  // namespace
}  // namespace zwidth::internal
