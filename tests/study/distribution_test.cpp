#include "zwidth/study/distribution.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using Kind = Distribution::Kind;

const std::vector<double> probabilities = {1e-15, 1e-6, 0.025, 0.3, 0.5, 0.7, 0.975, 1.0 - 1e-6};

// F(Q(u)) = u, with distribution functions in closed form.
TEST(Distribution, QuantilesInvertTheDistributionFunctions) {
  const QuantileFunction normal({.kind = Kind::normal, .centre = 3.0, .deviation = 0.5});
  const QuantileFunction lognormal({.kind = Kind::lognormal, .centre = 3.0, .deviation = 0.5});
  const QuantileFunction uniform({.kind = Kind::uniform, .lower = -1.0, .upper = 3.0});
  const QuantileFunction triangular({.kind = Kind::triangular, .centre = 1.0, .lower = 0.0, .upper = 4.0});
  const auto triangle = [](double x) { return x < 1.0 ? x * x / 4.0 : 1.0 - (4.0 - x) * (4.0 - x) / 12.0; };
  for (const double u : probabilities) {
    const double tolerance = 1e-12 * u + 1e-16;
    EXPECT_NEAR(standard_normal_probability((normal(u) - 3.0) / 0.5), u, 2e-14 + 1e-10 * u);
    EXPECT_NEAR(standard_normal_probability(std::log(lognormal(u) / 3.0) / 0.5), u, 2e-14 + 1e-10 * u);
    EXPECT_NEAR((uniform(u) + 1.0) / 4.0, u, 1e-15 + tolerance);
    EXPECT_NEAR(triangle(triangular(u)), u, 1e-15 + tolerance);
  }
  EXPECT_NEAR(normal(0.975), 3.0 + 0.5 * 1.959963984540054, 1e-14);
}

TEST(Distribution, WhatIsCutOffIsScaledToOne) {
  const QuantileFunction cut({.kind = Kind::normal, .centre = 0.0, .deviation = 1.0, .lower = -0.5, .upper = 2.0});
  const double below = standard_normal_probability(-0.5);
  const double inside = standard_normal_probability(2.0) - below;
  for (const double u : probabilities) {
    EXPECT_NEAR((standard_normal_probability(cut(u)) - below) / inside, u, 1e-14);
  }
  EXPECT_EQ(cut.least(), cut(0.0));
  EXPECT_GE(cut.least(), -0.5);
  EXPECT_LE(cut.largest(), 2.0);
  // Far in one tail: the exponential limit of a cut normal, mean excess 1/a (1 - 1/a^2 ...).
  const QuantileFunction tail({.kind = Kind::normal, .centre = 0.0, .deviation = 1.0, .lower = 7.0});
  EXPECT_NEAR(tail(1.0 - std::exp(-1.0)), 7.0 + 0.13834, 2e-3);
}

TEST(Distribution, DiscreteValuesHaveTheirShares) {
  const QuantileFunction discrete({.kind = Kind::discrete, .values = {1.0, 2.0, 5.0}, .weights = {1.0, 2.0, 1.0}});
  EXPECT_EQ(discrete(0.1), 1.0);
  EXPECT_EQ(discrete(0.2500001), 2.0);
  EXPECT_EQ(discrete(0.74), 2.0);
  EXPECT_EQ(discrete(0.76), 5.0);
  EXPECT_EQ(discrete.least(), 1.0);
  EXPECT_EQ(discrete.largest(), 5.0);
}

TEST(Distribution, ScoresAndUniformNumbersGiveTheSame) {
  for (const Distribution& each :
       {Distribution{.kind = Kind::normal, .centre = 3.0, .deviation = 0.5},
        Distribution{.kind = Kind::uniform, .lower = -1.0, .upper = 3.0},
        Distribution{.kind = Kind::lognormal, .centre = 3.0, .deviation = 0.5, .upper = 4.0}}) {
    const QuantileFunction quantile(each);
    for (const double z : {-5.0, -1.0, 0.0, 0.3, 4.0}) {
      EXPECT_NEAR(quantile.at_score(z), quantile(standard_normal_probability(z)), 1e-9);
    }
  }
}

TEST(Distribution, ImpossibleOnesAreNamed) {
  const auto member = [](const Distribution& distribution) {
    const auto problem = find_problem(distribution);
    return problem ? problem->member : "";
  };
  EXPECT_EQ(member({.kind = Kind::normal, .centre = 1.0, .deviation = 0.0}), "deviation");
  EXPECT_EQ(member({.kind = Kind::normal, .centre = std::numeric_limits<double>::quiet_NaN(), .deviation = 1.0}),
            "centre");
  EXPECT_EQ(member({.kind = Kind::lognormal, .centre = -1.0, .deviation = 1.0}), "centre");
  EXPECT_EQ(member({.kind = Kind::uniform, .lower = 1.0, .upper = 1.0}), "upper");
  EXPECT_EQ(member({.kind = Kind::uniform, .lower = 1.0}), "upper");
  EXPECT_EQ(member({.kind = Kind::triangular, .centre = 9.0, .lower = 1.0, .upper = 2.0}), "centre");
  EXPECT_EQ(member({.kind = Kind::normal, .centre = 0.0, .deviation = 1.0, .lower = 9.0}), "lower");
  EXPECT_EQ(member({.kind = Kind::discrete}), "values");
  EXPECT_EQ(member({.kind = Kind::discrete, .values = {2.0, 1.0}, .weights = {1.0, 1.0}}), "values");
  EXPECT_EQ(member({.kind = Kind::discrete, .values = {1.0}, .weights = {-1.0}}), "weights");
  EXPECT_THROW(QuantileFunction({.kind = Kind::discrete}), Error);
}

}  // namespace
}  // namespace zwidth
