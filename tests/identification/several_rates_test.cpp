// Recordings of one device at several rates, and sines too short for segments.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "campaign.hpp"
#include "identification/synthetic_bench.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

using test::Noise;
using test::SyntheticRecord;

constexpr double whole_turn = 2.0 * std::numbers::pi;

Recording named(std::string source, const SyntheticRecord& record, double rate) {
  return {std::move(source), 1.0 / rate, {{"force", record.force}, {"position", record.position}}, {}};
}

Device sampled_at(double rate) {
  DeviceParameters parameters = test::locked_lhifam_parameters();
  parameters.loop.sampling_period = 1.0 / rate;
  return Device(std::move(parameters));
}

Recording multisine_at(double rate, double recorded_rate, double amplitude, std::uint64_t seed) {
  ExcitationOptions options = test::multisine(5.0, std::min(400.0, 0.45 * rate), 6.0, 6);
  options.rate = rate;
  options.amplitude = amplitude;
  return named(std::to_string(rate),
               test::synthetic_record(sampled_at(recorded_rate), options, Noise{4e-7, 0.02, 0.0}, seed), recorded_rate);
}

/// Lines of the pooled response whose disc holds the truth of the first rate, and intervals of K_CR that hold it.
struct Held {
  std::size_t lines = 0;
  std::size_t held = 0;
  int intervals = 0;

  void add(const MeasuredResponse& found) {
    const SampledPlant plant = sampled_plant(sampled_at(1000.0));
    for (const ResponsePoint& point : found.response.points) {
      ++lines;
      const double radius = confidence_radius(point, found.response.averages);
      held += std::abs(point.value - response(plant, point.frequency)) <= radius ? 1U : 0U;
    }
    const double truth = critical_stiffness(filtered_plant(sampled_at(1000.0))).stiffness;
    const auto interval = found.stiffness ? stiffness_interval(*found.stiffness) : std::nullopt;
    intervals += interval && interval->lower <= truth && truth <= interval->upper ? 1 : 0;
  }
  [[nodiscard]] double share() const { return static_cast<double>(held) / static_cast<double>(lines); }
};

// Were refused: "must be of one rate".
TEST(SeveralRates, ClocksThatDifferByTenPartsPerMillionAreOneDevice) {
  Held pooled;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const MeasuredResponse found = frequency_response(
        std::vector{multisine_at(1000.0, 1000.0, 3.0, 2 * seed), multisine_at(1000.0, 1000.01, 5.0, 2 * seed + 1)});
    EXPECT_EQ(found.response.points.size(), 396U) << "a line of both is one";
    EXPECT_EQ(found.response.sampling_period, 1e-3);
    EXPECT_FALSE(found.dependence) << "seed " << seed;
    pooled.add(found);
  }
  EXPECT_GT(pooled.share(), 0.93);
  EXPECT_GE(pooled.intervals, 18);
}

TEST(SeveralRates, TwiceTheRateCountsAtTheFirstOnes) {
  const unsigned seeds = test::by_tier(10U, 20U);
  Held pooled;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const MeasuredResponse found = frequency_response(
        std::vector{multisine_at(1000.0, 1000.0, 3.0, 2 * seed), multisine_at(2000.0, 2000.0, 5.0, 2 * seed + 1)});
    EXPECT_EQ(found.response.points.size(), 396U);
    pooled.add(found);
  }
  EXPECT_GT(pooled.share(), 0.93);
  EXPECT_GE(pooled.intervals, 0.9 * seeds);
}

TEST(SeveralRates, IdentifyHoldsTheTruth) {
  IdentifyOptions options;
  options.fit.free = {"body.motor.mass", "body.motor.damping", "body.motor.stiffness"};
  const double truth = critical_stiffness(filtered_plant(sampled_at(1000.0))).stiffness;
  const unsigned seeds = test::by_tier(2U, 5U);
  int held = 0;
  int sound = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Identification found = identify(
        std::vector{multisine_at(1000.0, 1000.0, 3.0, 2 * seed), multisine_at(500.0, 500.0, 5.0, 2 * seed + 1)},
        sampled_at(1000.0), options);
    ASSERT_TRUE(found.analysis.interval) << "seed " << seed;
    held += found.analysis.interval->lower <= truth && truth <= found.analysis.interval->upper ? 1 : 0;
    sound += found.trust.sound() ? 1 : 0;
  }
  EXPECT_GE(held, 0.8 * seeds);  // none, where the images were taken for noise of each line's own
  EXPECT_GE(sound, 0.8 * seeds);
}

/// From rest.
Recording sine_of(double hertz, double seconds, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const Device device = sampled_at(1000.0);
  SyntheticRecord record;
  for (int k = 0; k < std::lround(1000.0 * seconds); ++k)
    record.force.push_back(5.0 * std::sin(whole_turn * hertz * 1e-3 * k));
  record.position = forced_response(sample(state_space(device), {1e-3, device.loop().delay}), record.force);
  for (double& value : record.position) value += 1e-6 * normal(random);
  return named(std::to_string(hertz) + ".csv", record, 1000.0);
}

// Were cut into segments of noise.
TEST(ShortSine, OfHardlyMoreThanAPeriodIsALine) {
  int held = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const FrequencyResponse found = frequency_response(sine_of(0.5, 2.4, seed)).response;
    ASSERT_EQ(found.points.size(), 1U) << "seed " << seed;
    const ResponsePoint& point = found.points[0];
    EXPECT_NEAR(point.frequency / whole_turn, 0.5, 1e-6);
    const auto truth = response(sampled_plant(sampled_at(1000.0)), point.frequency);
    held += std::abs(point.value - truth) <= confidence_radius(point, found.averages) ? 1 : 0;
    EXPECT_LT(confidence_radius(point, found.averages), 0.02 * std::abs(truth));
  }
  EXPECT_GE(held, 34);
}

TEST(ShortSine, OfOneFrequencyInEachFileNeedsNoFileWithAll) {
  const std::vector<double> hertz{0.5, 0.9, 1.6, 2.9, 7.3, 21.0, 55.0};
  std::vector<Recording> recordings;
  for (std::size_t i = 0; i < hertz.size(); ++i) recordings.push_back(sine_of(hertz[i], 2.4, i));
  FrequencyResponseOptions named_lines;
  for (const double each : hertz) named_lines.lines.push_back(whole_turn * each);
  for (const FrequencyResponseOptions& options : {FrequencyResponseOptions{}, named_lines}) {
    const MeasuredResponse found = frequency_response(recordings, options);
    ASSERT_EQ(found.response.points.size(), hertz.size());
    const SampledPlant plant = sampled_plant(sampled_at(1000.0));
    for (std::size_t i = 0; i < hertz.size(); ++i) {
      const ResponsePoint& point = found.response.points[i];
      EXPECT_NEAR(point.frequency / whole_turn, hertz[i], 1e-3);
      EXPECT_LE(std::abs(point.value - response(plant, point.frequency)), 0.03 * std::abs(point.value));
    }
    EXPECT_FALSE(found.dependence);
  }
}

}  // namespace
}  // namespace zwidth
