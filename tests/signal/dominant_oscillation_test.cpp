#include "zwidth/signal/dominant_oscillation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

constexpr double period = 1e-3;

TEST(DominantOscillation, OfASineOnALineWithNoise) {
  std::mt19937 engine(7);
  std::normal_distribution<double> noise(0.0, 1e-5);
  for (const double hertz : {3.17, 12.3, 90.0, 431.7}) {
    std::vector<double> signal;
    for (int i = 0; i < 8000; ++i) {
      signal.push_back(0.01 + 3e-6 * i + 2e-4 * std::sin(2.0 * std::numbers::pi * hertz * i * period) + noise(engine));
    }
    const auto found = dominant_oscillation(signal, period);
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->frequency / (2.0 * std::numbers::pi), hertz, 0.1 * found->resolution / (2.0 * std::numbers::pi));
    EXPECT_NEAR(found->amplitude, 2e-4, 0.03 * 2e-4);
    EXPECT_GT(found->share, 0.95);
    EXPECT_NEAR(found->change, 1.0, 0.01);
  }
}

TEST(DominantOscillation, IsAbsentWhereNothingMovesOrTooSlowly) {
  EXPECT_FALSE(dominant_oscillation(std::vector<double>(1000, 0.3), period));
  EXPECT_FALSE(dominant_oscillation(std::vector<double>(100, 0.3), period));
  std::vector<double> slow;
  for (int i = 0; i < 4000; ++i) slow.push_back(std::sin(2.0 * std::numbers::pi * 0.3 * i * period));
  EXPECT_FALSE(dominant_oscillation(slow, period));
  EXPECT_THROW(static_cast<void>(dominant_oscillation(slow, 0.0)), Error);
  slow[5] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(static_cast<void>(dominant_oscillation(slow, period)), Error);
}

}  // namespace
}  // namespace zwidth
