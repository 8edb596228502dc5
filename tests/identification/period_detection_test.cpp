#include "identification/response/period_detection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "identification/synthetic_bench.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
using namespace internal;
namespace {

std::vector<double> with_noise(std::vector<double> signal, double deviation) {
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal;
  for (double& value : signal) value += deviation * normal(generator);
  return signal;
}

TEST(PeriodDetection, FindsThePeriodOfAMultisine) {
  for (const std::size_t periods : {2U, 3U, 10U}) {
    const auto signal = excite(test::multisine(1.0, 200.0, 2.0 * static_cast<double>(periods), periods)).samples;
    EXPECT_EQ(detect_period(signal), 2000U) << periods;
  }
}

TEST(PeriodDetection, FindsItInAMeasuredForceThatBeginsLate) {
  auto signal = excite(test::multisine(1.0, 200.0, 20.0, 10)).samples;
  signal.insert(signal.begin(), 1234, 0.0);
  EXPECT_EQ(detect_period(with_noise(signal, 0.2)), 2000U);
}

TEST(PeriodDetection, FindsTheLeastPeriodOfASquareWaveAndOfASine) {
  std::vector<double> square(5000);
  std::vector<double> sine(5000);
  for (std::size_t i = 0; i < square.size(); ++i) {
    square[i] = i % 50 < 25 ? 1.0 : -1.0;
    sine[i] = std::sin(2.0 * std::numbers::pi * static_cast<double>(i) / 50.0);
  }
  EXPECT_EQ(detect_period(square), 50U);
  EXPECT_EQ(detect_period(sine), 50U);
}

// Twelve sines in four periods, recorded with noise of a tenth of their size: all 981 lines of segments were taken for excited.
TEST(PeriodDetection, FindsTheFourPeriodsOfSparseLinesUnderNoise) {
  constexpr std::size_t period = 5000;
  std::mt19937_64 random(2);
  std::normal_distribution<double> noise(0.0, 0.25);
  std::vector<double> force(4 * period);
  for (std::size_t i = 0; i < force.size(); ++i) {
    for (const double line : {5.0, 8.0, 12.0, 18.0, 27.0, 41.0, 62.0, 94.0, 142.0, 216.0, 329.0, 500.0}) {
      force[i] += std::sin(2.0 * std::numbers::pi * line * static_cast<double>(i) / period + line * line);
    }
    force[i] += noise(random);
  }
  EXPECT_EQ(detect_period(force), period);
}

TEST(PeriodDetection, FindsNoneWhereThereIsNone) {
  EXPECT_FALSE(detect_period(excite(test::chirp(1.0, 200.0, 20.0)).samples));
  EXPECT_FALSE(detect_period(excite(test::broadband_noise(1.0, 200.0, 20.0, 1)).samples));
  auto logarithmic = test::chirp(0.1, 200.0, 20.0);
  logarithmic.kind = ExcitationKind::logarithmic_chirp;
  EXPECT_FALSE(detect_period(excite(logarithmic).samples));
  EXPECT_FALSE(detect_period(std::vector<double>(1000, 3.0)));
  EXPECT_FALSE(detect_period(std::vector<double>{}));
  auto early = excite(test::chirp(1.0, 200.0, 5.0)).samples;
  early.insert(early.end(), 20000, 0.0);  // its last half is constant
  EXPECT_FALSE(detect_period(early));
  std::vector<double> ramp(1000);
  for (std::size_t i = 0; i < ramp.size(); ++i) ramp[i] = static_cast<double>(i);
  EXPECT_FALSE(detect_period(ramp));
}

// Three periods of 10 s from rest: a window over all of them was taken instead of the last two, doubtful and 4.5 % too high
// (found by a tester).
TEST(IdentifiedPeriods, LeaveOutTheFirstWhereTheTransientLastsThroughIt) {
  ExcitationOptions excitation = test::multisine(0.5, 150.0, 30.0, 3);
  excitation.amplitude = 5.0;
  DeviceParameters structure = test::lhifam_parameters();
  structure.loop.delay = 0.0;
  const Device truth(structure);
  test::SyntheticRecord record = test::synthetic_record(truth, excitation, {}, 1);
  for (double& position : record.position) position = 3e-6 * std::round(position / 3e-6);
  IdentifyOptions options;
  options.structure_values = IdentifyOptions::StructureValues::placeholders;
  options.method = IdentifyOptions::Method::lines;
  const Identification found = identify(
      Recording{"three periods", 1e-3, {{"force", record.force}, {"position", record.position}}, {}}, truth, options);
  const double stiffness = critical_stiffness(truth).stiffness;
  ASSERT_TRUE(found.analysis.interval);
  EXPECT_LE(found.analysis.interval->lower, stiffness);
  EXPECT_GE(found.analysis.interval->upper, stiffness);
}

}  // namespace
}  // namespace zwidth
