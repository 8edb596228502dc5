#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "campaign.hpp"
#include "identification/friction_body.hpp"
#include "identification/synthetic_bench.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/measured_response.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

using test::Noise;
using test::SyntheticRecord;
using ::testing::HasSubstr;

constexpr double period = 1e-3;
constexpr double turn = 2.0 * std::numbers::pi;

Recording recording(std::string source, const SyntheticRecord& record, double sampling_period = period) {
  return {std::move(source), sampling_period, {{"force", record.force}, {"position", record.position}}, {}};
}

double truth_of(const Device& device) { return critical_stiffness(filtered_plant(device)).stiffness; }

/// How often 95 % discs, and intervals of the critical stiffness, hold the device's own.
class Coverage {
 public:
  explicit Coverage(const Device& device) : plant_(sampled_plant(device)), stiffness_(truth_of(device)) {}

  void add(const FrequencyResponse& found) {
    for (const ResponsePoint& point : found.points) {
      ++lines_;
      if (std::abs(point.value - response(plant_, point.frequency)) <= confidence_radius(point, found.averages))
        ++held_;
    }
  }
  void add(const MeasuredResponse& found) {
    add(found.response);
    const auto interval = found.stiffness ? stiffness_interval(*found.stiffness) : std::nullopt;
    intervals += interval && interval->lower <= stiffness_ && stiffness_ <= interval->upper ? 1 : 0;
  }
  void expect_share(double least, double most) const {
    const double share = static_cast<double>(held_) / static_cast<double>(lines_);
    EXPECT_GT(share, least);
    EXPECT_LT(share, most);
  }

  int intervals = 0;  ///< that hold

 private:
  SampledPlant plant_;
  double stiffness_;
  std::size_t lines_ = 0;
  std::size_t held_ = 0;
};

/// Two multisines of the locked device, one of a tenth of the other's force, in different noise.
std::vector<Recording> two_multisines(const Device& device, std::uint64_t seed) {
  ExcitationOptions strong = test::multisine(5.0, 400.0, 6.0, 6);
  ExcitationOptions weak = strong;
  weak.amplitude = 0.1 * strong.amplitude;
  return {recording("weak.csv", test::synthetic_record(device, weak, Noise{3e-7, 0.01, 0.0}, 2 * seed)),
          recording("strong.csv", test::synthetic_record(device, strong, Noise{6e-7, 0.05, 0.0}, 2 * seed + 1))};
}

TEST(PooledResponse, IntervalsOfTwoMultisinesHoldTheTruth) {
  const Device device(test::locked_lhifam_parameters());
  Coverage coverage(device);
  int dependent = 0;
  const unsigned seeds = test::by_tier(25U, 100U);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const MeasuredResponse found = frequency_response(two_multisines(device, seed));
    EXPECT_EQ(found.response.points.size(), 396U) << "seed " << seed;
    coverage.add(found);
    dependent += found.dependence ? 1 : 0;
    ASSERT_TRUE(found.stiffness && stiffness_interval(*found.stiffness)) << "seed " << seed;
  }
  coverage.expect_share(0.93, 0.985);
  EXPECT_GE(coverage.intervals, 0.9 * seeds);
  EXPECT_EQ(dependent, 0);
}

TEST(PooledResponse, TwoRecordingsKnowMoreThanEither) {
  const Device device(test::locked_lhifam_parameters());
  const auto record = [&](std::uint64_t seed, double duration) {
    return recording(
        "noise" + std::to_string(seed) + ".csv",
        test::synthetic_record(device, test::broadband_noise(5.0, 400.0, duration, seed), Noise{1e-6, 0.0, 0.0}, seed));
  };
  Coverage coverage(device);
  double ratio = 0.0;  // of variances, summed over the lines of all seeds
  double lines = 0.0;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const std::vector<Recording> both{record(2 * seed, 20.0), record(2 * seed + 1, 37.0)};
    FrequencyResponseOptions options = test::welch();
    options.segment_length = 1024;
    const auto pooled = frequency_response(both, options);
    const auto longer = frequency_response(both[1], options);
    // At equal noise the variance falls as the time grows, from 37 s to 57 s.
    for (const ResponsePoint& point : pooled.response.points) {
      for (const ResponsePoint& single : longer.response.points) {
        if (single.frequency != point.frequency) continue;
        ratio += point.variance / single.variance;
        lines += 1.0;
      }
    }
    EXPECT_FALSE(pooled.dependence) << "seed " << seed;
    coverage.add(pooled.response);
  }
  EXPECT_NEAR(ratio / lines, 37.0 / 57.0, 0.03);
  coverage.expect_share(0.90, 0.99);
}

TEST(PooledResponse, DryFrictionShowsAsADependenceOnTheForce) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  const auto record = [&](const std::string& name, double amplitude) {
    ExcitationOptions options = test::multisine(1.0, 50.0, 20.0, 10);
    options.amplitude = amplitude;
    const Excitation excitation = excite(options);
    test::FrictionBody body{0.5, 2.0, 0.4};
    SyntheticRecord made{excitation.samples, {}, excitation.period};
    for (const double force : made.force) {
      made.position.push_back(body.position + 1e-7 * normal(random));
      body.move(force, period);
    }
    return recording(name, made);
  };
  const MeasuredResponse found = frequency_response(std::vector{record("weak.csv", 3.0), record("strong.csv", 12.0)});
  ASSERT_TRUE(found.dependence);
  EXPECT_TRUE(found.dependence->grows_with_force);
  EXPECT_NEAR(found.dependence->force_ratio, 4.0, 1e-6);
  EXPECT_GT(found.dependence->difference, 0.02);
  EXPECT_FALSE(found.trust.sound());
  EXPECT_THAT(found.remarks, ::testing::Contains(::testing::Field(&Remark::what, HasSubstr("4 times the force"))));
}

/// A record of one sine from rest, of a frequency that fits no number of samples, its force as measured.
Recording sine(const Device& device, double hertz, const Noise& noise, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const Loop& loop = device.loop();
  SyntheticRecord record;
  for (int k = 0; k < 4000; ++k) record.force.push_back(5.0 * std::sin(turn * hertz * period * k));
  record.position = forced_response(sample(state_space(device), {loop.sampling_period, loop.delay}), record.force);
  for (double& value : record.position) value += noise.position * normal(random);
  for (double& value : record.force) value += noise.measured_force * normal(random);
  return recording(std::to_string(hertz) + ".csv", record);
}

TEST(PooledResponse, ASineInEachRecordingMakesALineEach) {
  const Device device(test::locked_lhifam_parameters());
  Coverage coverage(device);
  constexpr int seeds = 40;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    std::vector<Recording> recordings;
    for (int i = 0; i < 14; ++i) {
      recordings.push_back(sine(device, 21.3 + 11.7 * i, Noise{1e-6, 0.0, 0.3}, 100 * seed + static_cast<unsigned>(i)));
    }
    const MeasuredResponse found = frequency_response(recordings);
    ASSERT_EQ(found.response.points.size(), 14U) << "seed " << seed;
    for (std::size_t i = 0; i < 14; ++i) {
      EXPECT_NEAR(found.response.points[i].frequency / turn, 21.3 + 11.7 * static_cast<double>(i), 2e-3);
    }
    coverage.add(found);
    ASSERT_TRUE(found.stiffness && stiffness_interval(*found.stiffness)) << "seed " << seed;
  }
  coverage.expect_share(0.91, 0.99);
  EXPECT_GE(coverage.intervals, 36);
}

/// A sparse multisine with the force as measured, noisy.
SyntheticRecord sparse(const Device& device, double spacing_hz, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const Loop& loop = device.loop();
  SyntheticRecord record;
  for (int k = 0; k < 20000; ++k) {
    double force = 0.0;
    for (int line = 1; line <= 12; ++line) force += std::sin(spacing_hz * turn * line * period * k + 1.3 * line * line);
    record.force.push_back(force);
  }
  record.position = forced_response(sample(state_space(device), {loop.sampling_period, loop.delay}), record.force);
  for (double& value : record.position) value += 1e-6 * normal(random);
  for (double& value : record.force) value += 1.0 * normal(random);
  return record;
}

TEST(PooledResponse, LinesOfASparseMultisineAreFoundByTheirPower) {
  const Device device(test::locked_lhifam_parameters());
  Coverage coverage(device);
  int wrong = 0;
  constexpr int seeds = 60;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const SyntheticRecord record = sparse(device, 10.0, seed);
    FrequencyResponseOptions options = test::over_periods(1000, 1);
    const FrequencyResponse found = frequency_response(record.force, record.position, period, options);
    wrong += found.points.size() == 12 ? 0 : 1;
    coverage.add(found);
    // Without the period: it is found in the noise.
    EXPECT_EQ(frequency_response(record.force, record.position, period).points.size(), 12U) << "seed " << seed;
  }
  EXPECT_LE(wrong, 1);
  coverage.expect_share(0.92, 0.985);
}

TEST(PooledResponse, LinesThatAreGivenNeedNoWholePeriod) {
  const Device device(test::locked_lhifam_parameters());
  FrequencyResponseOptions options;
  for (int line = 1; line <= 12; ++line) options.lines.push_back(9.7 * turn * line);
  Coverage coverage(device);
  constexpr int seeds = 60;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    SyntheticRecord record = sparse(device, 9.7, seed);
    const FrequencyResponse found = frequency_response(record.force, record.position, period, options);
    ASSERT_EQ(found.points.size(), 12U);
    coverage.add(found);
  }
  coverage.expect_share(0.92, 0.985);
}

TEST(PooledResponse, IdentifiesADeviceFromSeveralRecordings) {
  const Device device(test::locked_lhifam_parameters());
  IdentifyOptions options;
  options.fit.free = {"body.motor.mass", "body.motor.damping", "body.motor.stiffness"};
  options.method = IdentifyOptions::Method::lines;
  int held = 0;
  const unsigned seeds = test::by_tier(4U, 20U);
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    const Identification found = identify(two_multisines(device, seed), device, options);
    ASSERT_TRUE(found.analysis.interval) << "seed " << seed;
    held += found.analysis.interval->lower <= truth_of(device) && truth_of(device) <= found.analysis.interval->upper;
  }
  EXPECT_GE(held, test::by_tier(3, 17));  // chance leaves fewer of 4 or of 20 once in 70 times
}

TEST(PooledResponse, RefusesWhatDoesNotBelongTogether) {
  const Device device(test::locked_lhifam_parameters());
  const std::vector<Recording> good = two_multisines(device, 1);
  const auto message = [&](const std::vector<Recording>& recordings, const FrequencyResponseOptions& options = {}) {
    try {
      (void)frequency_response(recordings, options);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
      return std::string(error.what());
    }
    return std::string("nothing is refused");
  };
  EXPECT_THAT(message({}), HasSubstr("there is no recording"));
  Recording other = good[1];
  other.sampling_period = 0.0;
  EXPECT_THAT(message({good[0], other}), HasSubstr("strong.csv: "));
  Recording empty = good[1];
  for (Channel& channel : empty.channels) channel.samples.clear();
  EXPECT_THAT(message({good[0], empty}), HasSubstr("strong.csv: the record has 0 samples; at least 16"));
  Recording same = good[0];
  same.source = "copy.csv";
  EXPECT_THAT(message({good[0], same}), HasSubstr("copy.csv: holds the same samples as weak.csv"));
  FrequencyResponseOptions options;
  options.lines = {turn * 20.0, turn * 600.0};
  EXPECT_THAT(message(good, options), HasSubstr("weak.csv: line at 600 Hz; below half the sampling rate, 500 Hz"));
  options.lines = {turn * 20.0, turn * 20.0};
  EXPECT_THAT(message(good, options), HasSubstr("line at 20 Hz comes twice; each once"));
  options.lines = {turn * 20.0, turn * 20.01};
  EXPECT_THAT(message(good, options), HasSubstr("too short to tell the lines apart; at least 300 s"));
  options.lines = {-1.0};
  EXPECT_THAT(message(good, options), HasSubstr("lines has -0.159155 Hz; must be finite and above 0"));
}

}  // namespace
}  // namespace zwidth
