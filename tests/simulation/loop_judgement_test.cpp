// What is said of a motion, on signals that are known.
#include "simulation/loop_judgement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace zwidth {
using namespace internal;
namespace {

using std::numbers::pi;

// The judgement itself, on signals made for it.
std::vector<double> signal(double growth, double frequency_hz, double drift, double curve) {
  std::vector<double> y;
  for (int k = 0; k < 4000; ++k) {
    const double t = k * 1e-3;
    y.push_back(std::exp(growth * t) * std::sin(2.0 * pi * frequency_hz * t) + drift * t + curve * t * t);
  }
  return y;
}

TEST(Judgement, OfKnownSignals) {
  for (const double frequency : {5.3, 17.0, 101.7, 333.3, 471.0}) {
    for (const double drift : {0.0, 0.3}) {
      SCOPED_TRACE(frequency);
      const auto verdict = [&](double growth) {
        return judge_loop(signal(growth, frequency, drift, 0.0), 1e-3, 0.0).verdict;
      };
      EXPECT_EQ(verdict(0.0), LoopVerdict::limit_cycle);
      EXPECT_EQ(verdict(0.3), LoopVerdict::unstable);
      EXPECT_EQ(verdict(-0.3), LoopVerdict::settles);
    }
  }
}

// A force that chatters ripples a steady swing: the frequency is that of the swing, whose amplitude stands beside it.
TEST(Judgement, RipplesOnASwingAreNotItsFrequency) {
  std::vector<double> rippled;
  for (double t = 0.0; t < 8.0; t += 1e-3) {
    rippled.push_back(3.0 * std::sin(2.0 * pi * 3.3 * t) + 0.3 * std::sin(2.0 * pi * 121.0 * t));
  }
  const LoopJudgement judgement = judge_loop(rippled, 1e-3, 1e-3);
  ASSERT_TRUE(judgement.oscillation);
  EXPECT_NEAR(judgement.oscillation->frequency / (2.0 * pi), 3.3, 0.05);
}

// A second mode whose ripple adds a cycle here and there, on a swing that grows.
TEST(Judgement, AFewMoreLowestPointsAreNotTheFrequency) {
  std::vector<double> rippled;
  for (double t = 0.0; t < 2.0; t += 5e-4) {
    rippled.push_back(1e-3 * std::exp(0.09 * t) * (std::sin(67.88 * t) + 0.08 * std::sin(1055.0 * t)));
  }
  const LoopJudgement judgement = judge_loop(rippled, 5e-4, 0.0);
  ASSERT_TRUE(judgement.oscillation);
  EXPECT_NEAR(judgement.oscillation->frequency, 67.88, 1.0);
}

TEST(Judgement, MeasuresGrowthFrequencyAndAmplitude) {
  const LoopJudgement judgement = judge_loop(signal(-0.25, 23.7, 0.5, 0.0), 1e-3, 0.0);
  EXPECT_NEAR(*judgement.growth_rate, -0.25, 0.005);
  EXPECT_NEAR(judgement.oscillation->frequency, 2.0 * pi * 23.7, 1e-3 * 2.0 * pi * 23.7);
  EXPECT_NEAR(judgement.oscillation->amplitude, std::exp(-0.25 * 4.0), 0.05);
}

TEST(Judgement, ACurveIsNoOscillation) {
  for (const double curve : {-2.0, 0.1, 5.0}) {
    std::vector<double> y;
    for (int k = 0; k < 4000; ++k) y.push_back(curve * k * k * 1e-6 + 0.001 * k);
    EXPECT_NE(judge_loop(y, 1e-3, 0.0).verdict, LoopVerdict::limit_cycle) << curve;
    for (double& each : y) each = std::exp(each / 10.0);
    EXPECT_NE(judge_loop(y, 1e-3, 0.0).verdict, LoopVerdict::limit_cycle) << curve;
  }
}

TEST(Judgement, RestIsRest) {
  EXPECT_EQ(judge_loop(std::vector<double>(1000, 0.37), 1e-3, 0.0).verdict, LoopVerdict::settles);
  std::vector<double> stops = signal(0.0, 20.0, 0.0, 0.0);
  for (std::size_t k = 2500; k < stops.size(); ++k) stops[k] = stops[2500];
  EXPECT_EQ(judge_loop(stops, 1e-3, 0.0).verdict, LoopVerdict::settles);
}

TEST(Judgement, NoOscillationIsFasterThanNyquist) {
  std::vector<double> alternating(400);
  for (std::size_t k = 0; k < alternating.size(); ++k) {
    alternating[k] = (k % 2 == 0 ? 1.0 : -1.0) * std::exp(0.02 * static_cast<double>(k));
  }
  const LoopJudgement judgement = judge_loop(alternating, 1e-3, 0.0);
  EXPECT_EQ(judgement.verdict, LoopVerdict::unstable);
  ASSERT_TRUE(judgement.oscillation.has_value());
  EXPECT_LE(judgement.oscillation->frequency, pi / 1e-3);
  EXPECT_NEAR(judgement.oscillation->frequency, pi / 1e-3, 0.01 * pi / 1e-3);
}

}  // namespace
}  // namespace zwidth
