#include "identification/crossover/local_estimate.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace zwidth {
using namespace internal;
namespace {

std::vector<CurveSample> noisy(std::size_t count, double sigma, unsigned seed, double (*curve)(double)) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  std::vector<CurveSample> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = static_cast<double>(i);
    samples.push_back({x, curve(x) + sigma * normal(generator), sigma});
  }
  return samples;
}

double parabola(double x) { return 1.0 + 0.3 * x - 0.01 * x * x; }
double kink(double x) { return x < 30.0 ? 0.0 : 5.0 * (x - 30.0); }

TEST(LocalEstimate, AParabolaIsReproducedFromAllSamples) {
  const auto samples = noisy(41, 0.0, 1, parabola);
  std::vector<CurveSample> given = samples;
  for (CurveSample& sample : given) sample.sigma = 0.1;
  for (const std::size_t i : {0U, 20U, 40U}) {
    const Estimate estimate = local_estimate(given, i, 1.0);
    EXPECT_NEAR(estimate.value, parabola(static_cast<double>(i)), 1e-9);
    EXPECT_LT(estimate.sigma, 0.08);
  }
}

TEST(LocalEstimate, IntervalsHoldTheCurve) {
  int held = 0;
  int total = 0;
  double sigma = 0.0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const auto samples = noisy(61, 0.2, seed, parabola);
    for (std::size_t i = 5; i < 56; i += 10) {
      const Estimate estimate = local_estimate(samples, i, 1.0);
      ++total;
      sigma += estimate.sigma;
      if (std::abs(estimate.value - parabola(static_cast<double>(i))) < 1.96 * estimate.sigma) ++held;
    }
  }
  EXPECT_GT(held, total * 85 / 100);
  EXPECT_LT(sigma / total, 0.12);  // smoothing helps
}

TEST(LocalEstimate, DoesNotSmoothOverAKink) {
  const auto samples = noisy(61, 0.01, 1, kink);
  EXPECT_NEAR(local_estimate(samples, 30, 1.0).value, 0.0, 0.04);
  EXPECT_NEAR(local_estimate(samples, 31, 1.0).value, 5.0, 0.04);
}

TEST(LocalEstimate, CorrelatedErrorsLeaveMoreDoubt) {
  const auto samples = noisy(61, 0.2, 3, parabola);
  EXPECT_GT(local_estimate(samples, 30, 2.0).sigma, 1.2 * local_estimate(samples, 30, 1.0).sigma);
}

TEST(LocalEstimate, SamplesThatDoNotCountAreLeftOut) {
  auto samples = noisy(41, 0.0, 1, parabola);
  for (CurveSample& sample : samples) sample.sigma = 0.1;
  for (const std::size_t i : {15U, 22U}) {
    samples[i].y = 1e6;
    samples[i].counts = false;
  }
  EXPECT_NEAR(local_estimate(samples, 20, 1.0).value, parabola(20.0), 1e-9);
}

}  // namespace
}  // namespace zwidth
