#include "zwidth/study/sample_statistics.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

// R 4.2, binom.test(): 4 of 20, 0 of 10, 10 of 10.
TEST(Proportion, IsClopperAndPearsons) {
  const Proportion four = proportion(4, 20);
  EXPECT_NEAR(four.lower, 0.0573340, 1e-7);
  EXPECT_NEAR(four.upper, 0.4366140, 1e-7);
  EXPECT_EQ(proportion(0, 10).lower, 0.0);
  EXPECT_NEAR(proportion(0, 10).upper, 1.0 - std::pow(0.025, 0.1), 1e-14);
  EXPECT_NEAR(proportion(10, 10).lower, std::pow(0.025, 0.1), 1e-14);
  EXPECT_EQ(proportion(10, 10).upper, 1.0);
  EXPECT_THROW((void)proportion(3, 2), Error);
  EXPECT_THROW((void)proportion(0, 0), Error);
  EXPECT_THROW((void)proportion(1, 2, 1.0), Error);
}

// The exact coverage, summed over all counts, is never below what is promised.
TEST(Proportion, CoversTheTruthAsPromised) {
  constexpr int n = 30;
  for (const double p : {0.01, 0.1, 0.37, 0.5, 0.95}) {
    double covered = 0.0;
    for (int k = 0; k <= n; ++k) {
      const Proportion share = proportion(static_cast<std::uint64_t>(k), n);
      if (share.lower > p || share.upper < p) continue;
      covered += std::exp(std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1) + k * std::log(p) +
                          (n - k) * std::log1p(-p));
    }
    EXPECT_GE(covered, 0.95) << p;
  }
}

// Wilks 1941; the table of first, second and third order for 95/95 is 59, 93, 124 (e.g. IAEA Safety Reports 52).
TEST(ToleranceRank, NeedsFiftyNineSamples) {
  EXPECT_EQ(wilks_samples(0.95, 0.95), 59U);
  EXPECT_EQ(tolerance_rank(0.95, 0.95, 58), std::nullopt);
  EXPECT_EQ(tolerance_rank(0.95, 0.95, 59), 1U);
  EXPECT_EQ(tolerance_rank(0.95, 0.95, 92), 1U);
  EXPECT_EQ(tolerance_rank(0.95, 0.95, 93), 2U);
  EXPECT_EQ(tolerance_rank(0.95, 0.95, 123), 2U);
  EXPECT_EQ(tolerance_rank(0.95, 0.95, 124), 3U);
  EXPECT_EQ(wilks_samples(0.99, 0.95), 299U);
}

// By the definition, with the binomial summed term by term.
TEST(QuantileRanks, LeaveHalfOfTheRestOnEachSide) {
  const auto below = [](std::uint64_t k, std::uint64_t n, double p) {  // P(B <= k - 1)
    double sum = 0.0;
    for (std::uint64_t i = 0; i < k; ++i) {
      sum += std::exp(std::lgamma(static_cast<double>(n) + 1.0) - std::lgamma(static_cast<double>(i) + 1.0) -
                      std::lgamma(static_cast<double>(n - i) + 1.0) + static_cast<double>(i) * std::log(p) +
                      static_cast<double>(n - i) * std::log1p(-p));
    }
    return sum;
  };
  for (const std::uint64_t n : {10U, 100U, 777U}) {
    for (const double p : {0.01, 0.05, 0.5, 0.9}) {
      const QuantileRanks ranks = quantile_ranks(p, n);
      if (ranks.lower) {
        EXPECT_LE(below(*ranks.lower, n, p), 0.025 + 1e-12) << n << " " << p;
        EXPECT_GT(below(*ranks.lower + 1, n, p), 0.025) << n << " " << p;
      } else {
        EXPECT_GT(below(1, n, p), 0.025);
      }
      if (ranks.upper) {
        EXPECT_GE(below(*ranks.upper, n, p), 0.975 - 1e-12);
        EXPECT_LT(below(*ranks.upper - 1, n, p), 0.975);
      } else {
        EXPECT_LT(below(n, n, p), 0.975);
      }
    }
  }
}

// Of equal weights: Garwood's interval of 10 that were counted, 4.795 to 18.390 (F. Garwood, Biometrika 28, 437, 1936).
TEST(WeightedSumInterval, OfEqualWeightsIsThatOfACount) {
  const StatisticInterval ten = weighted_sum_interval(10.0, 10.0, 1.0);
  EXPECT_NEAR(ten.lower, 4.7954, 1e-4);
  EXPECT_NEAR(ten.upper, 18.3904, 1e-4);
  const StatisticInterval scaled = weighted_sum_interval(10e-9, 10e-18, 1e-9);
  EXPECT_NEAR(scaled.lower, ten.lower * 1e-9, 1e-21);
  EXPECT_NEAR(scaled.upper, ten.upper * 1e-9, 1e-21);
  EXPECT_THROW((void)weighted_sum_interval(0.0, 0.0, 0.0), Error);
  EXPECT_THROW((void)weighted_sum_interval(1.0, 1.0, 2.0), Error);
  EXPECT_THROW((void)weighted_sum_interval(1.0, 1.0, 1.0, 1.0), Error);
}

TEST(OrderStatistics, AreThoseOfTheSortedNumbers) {
  std::mt19937_64 random(3);
  std::vector<double> numbers(5000);
  for (double& number : numbers) {
    number = std::ldexp(static_cast<double>(random() >> 40U), static_cast<int>(random() % 60)) *
             (random() % 5 == 0 ? -1 : 1);
  }
  numbers[7] = numbers[9] = std::numeric_limits<double>::quiet_NaN();
  numbers[8] = std::numeric_limits<double>::infinity();
  numbers[100] = 0.0, numbers[101] = -0.0, numbers[102] = numbers[103];
  const auto pass = [&](const std::function<void(double)>& take) {
    for (const double number : numbers) take(number);
  };
  const std::vector<double> found = order_statistics({1, 2, 3, 1000, 2500, 4999, 5000}, pass);
  std::ranges::sort(numbers, [](double a, double b) { return std::isnan(a) ? !std::isnan(b) : a < b; });
  EXPECT_TRUE(std::isnan(found[0]));
  EXPECT_TRUE(std::isnan(found[1]));
  EXPECT_EQ(found[2], numbers[2]);
  EXPECT_EQ(found[3], numbers[999]);
  EXPECT_EQ(found[4], numbers[2499]);
  EXPECT_EQ(found[5], numbers[4998]);
  EXPECT_EQ(found[6], std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace zwidth
