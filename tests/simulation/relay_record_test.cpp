#include "zwidth/simulation/relay_record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "zwidth/error.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;
using ::testing::Contains;
using ::testing::Field;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr double period = 1e-3;

struct Record {
  std::vector<double> force;
  std::vector<double> position;
};

/// A square wave of +-d against a sine of amplitude X e(t) in opposite phase: the steady picture of section V.
Record relay_record(
    std::size_t samples, double frequency_hz, double d, double x,
    const std::function<double(double)>& envelope = [](double) { return 1.0; }) {
  Record record;
  for (std::size_t k = 0; k < samples; ++k) {
    // Off the samples by a hair, so that no switch falls on one.
    const double phase = 2.0 * pi * frequency_hz * (static_cast<double>(k) * period + 1e-7);
    record.force.push_back(std::sin(phase) > 0.0 ? -d : d);
    record.position.push_back(x * envelope(static_cast<double>(k) * period) * std::sin(phase));
  }
  return record;
}

RelayReading analysed(const Record& record, const RelayAnalysisOptions& options = {}) {
  const auto result = analyse_relay_record(record.force, record.position, period, options);
  if (!result) {
    ADD_FAILURE() << text(result.error().why);
    return {};
  }
  return *result;
}

/// `stated` where it oscillates.
Finding failure(const Record& record) {
  const auto result = analyse_relay_record(record.force, record.position, period);
  return result ? Finding{} : result.error().why;
}

/// Relative error of the cycles' frequency: the straight line through N cycles of a sine falls by 6 X / (pi N), which
/// moves the first and the last rise apart by 3 / (pi^2 N^2) of the time between them.
double tilt(double frequency_hz, double samples) {
  const double cycles = std::floor(frequency_hz * period * samples) - 1.0;
  return 1.05 * 3.0 / (pi * pi * cycles * cycles) + 1e-6;
}

auto has_remark(const std::string& text) { return Contains(Field(&Remark::what, HasSubstr(text))); }

TEST(RelayRecord, ReadsFrequencyAndGainOnALine) {
  // 41 lines of 1000/8192 Hz: about 5 Hz, 200 samples per cycle.
  const double frequency = 41.0 * 1000.0 / 8192.0;
  const RelayReading result = analysed(relay_record(3 * 8192, frequency, 5.0, 1e-3));
  EXPECT_NEAR(result.frequency, 2.0 * pi * frequency, 1e-9);
  EXPECT_NEAR(result.line_spacing, 2.0 * pi * 1000.0 / 8192.0, 1e-12);
  // First harmonic of the sampled square wave: 4 d/pi but for its switches' rounding to samples.
  EXPECT_NEAR(result.stiffness, 4.0 * 5.0 / (pi * 1e-3), 2e-4 * result.stiffness);
  EXPECT_NEAR(result.amplitude, 1e-3, 1e-6);
  ASSERT_TRUE(result.cycle_frequency);
  EXPECT_NEAR(*result.cycle_frequency, 2.0 * pi * frequency, tilt(frequency, 3 * 8192) * result.frequency);
  EXPECT_EQ(result.steady_from, 0U);
  EXPECT_THAT(result.remarks, IsEmpty());
}

TEST(RelayRecord, BetweenLinesTheCyclesKnowTheFrequency) {
  for (const double frequency : {2.3, 4.44, 17.03, 61.6}) {
    SCOPED_TRACE(frequency);
    const RelayReading result = analysed(relay_record(20000, frequency, 5.0, 1e-3));
    EXPECT_LE(std::abs(result.frequency - 2.0 * pi * frequency), 0.51 * result.line_spacing);
    ASSERT_TRUE(result.cycle_frequency);
    EXPECT_NEAR(*result.cycle_frequency, 2.0 * pi * frequency, tilt(frequency, 20000) * result.frequency);
    EXPECT_NEAR(result.stiffness, 4.0 * 5.0 / (pi * 1e-3), 0.005 * result.stiffness);
  }
}

TEST(RelayRecord, UnitsScaleTheStiffnessAndNothingElse) {
  const Record record = relay_record(20000, 4.44, 5.0, 1e-3);
  Record scaled = record;
  for (double& each : scaled.force) each *= 1e-3;
  for (double& each : scaled.position) each *= 1e6;
  const RelayReading plain = analysed(record);
  const RelayReading other = analysed(scaled);
  EXPECT_DOUBLE_EQ(other.frequency, plain.frequency);
  EXPECT_NEAR(other.stiffness, 1e-9 * plain.stiffness, 1e-12 * other.stiffness);
  EXPECT_EQ(other.steady_from, plain.steady_from);
}

TEST(RelayRecord, AnOffsetAndASlowDriftOfTheEncoderDoNotMoveTheAnswer) {
  Record record = relay_record(20000, 4.44, 5.0, 1e-3);
  const RelayReading plain = analysed(record);
  for (std::size_t k = 0; k < record.position.size(); ++k) record.position[k] += 0.3 + 1e-8 * static_cast<double>(k);
  const RelayReading moved = analysed(record);
  EXPECT_DOUBLE_EQ(moved.frequency, plain.frequency);
  EXPECT_NEAR(moved.stiffness, plain.stiffness, 1e-4 * plain.stiffness);
}

// The peak and the quotient against a direct sum over the same Hann segments, three quarters overlapping.
TEST(RelayRecord, SpectraAreThoseOfADirectSum) {
  RelayAnalysisOptions options;
  options.segment_length = 256;
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0.0, 0.05);
  Record record = relay_record(1024, 31.0, 1.0, 1.0);
  for (double& each : record.position) each += noise(random);
  const RelayReading result = analysed(record, options);
  ASSERT_EQ(result.steady_from, 0U);
  const auto line_free = [](const std::vector<double>& signal) {
    const auto n = static_cast<double>(signal.size());
    double sum = 0.0;
    double moment = 0.0;
    for (std::size_t i = 0; i < signal.size(); ++i) {
      sum += signal[i];
      moment += (static_cast<double>(i) - 0.5 * (n - 1.0)) * signal[i];
    }
    std::vector<double> rest = signal;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      rest[i] -= sum / n + 12.0 * moment / (n * (n * n - 1.0)) * (static_cast<double>(i) - 0.5 * (n - 1.0));
    }
    return rest;
  };
  const std::vector<double> f = line_free(record.force);
  const std::vector<double> x = line_free(record.position);
  const auto k = static_cast<std::size_t>(std::round(result.frequency / result.line_spacing));
  std::complex<double> cross = 0.0;
  double power = 0.0;
  std::size_t count = 0;
  for (std::size_t start = 0; start + 256 <= f.size(); start += 64, ++count) {
    std::complex<double> force = 0.0;
    std::complex<double> position = 0.0;
    for (std::size_t i = 0; i < 256; ++i) {
      const double window = 0.5 - 0.5 * std::cos(2.0 * pi * static_cast<double>(i) / 256.0);
      const auto turn = std::polar(window, -2.0 * pi * static_cast<double>(i * k) / 256.0);
      force += f[start + i] * turn;
      position += x[start + i] * turn;
    }
    cross += std::conj(force) * position;
    power += std::norm(force);
  }
  EXPECT_EQ(result.segments, count);
  EXPECT_NEAR(result.stiffness, power / std::abs(cross), 1e-10 * result.stiffness);
}

TEST(RelayRecord, ATransientIsLeftOut) {
  // Starts ten times as large and dies down within 1 s time constant: 5 % is reached after ln(9/0.05) = 5.2 s.
  const Record record = relay_record(20000, 4.44, 5.0, 1e-3, [](double t) { return 1.0 + 9.0 * std::exp(-t / 1.0); });
  const RelayReading result = analysed(record);
  EXPECT_GT(result.steady_from, 4000U);
  EXPECT_LT(result.steady_from, 7000U);
  EXPECT_NEAR(result.stiffness, 4.0 * 5.0 / (pi * 1e-3), 0.02 * result.stiffness);
  EXPECT_THAT(result.remarks, IsEmpty());
}

TEST(RelayRecord, AGrowingSwingIsRemarked) {
  const Record record = relay_record(20000, 4.44, 5.0, 1e-3, [](double t) { return std::exp(0.05 * t); });
  EXPECT_THAT(analysed(record).remarks, has_remark("the swing still grows"));
  const Record falling = relay_record(20000, 4.44, 5.0, 1e-3, [](double t) { return std::exp(-0.05 * t); });
  EXPECT_THAT(analysed(falling).remarks, has_remark("the swing still falls"));
}

TEST(RelayRecord, AnUnsteadySwingIsRemarked) {
  const Record record =
      relay_record(20000, 4.44, 5.0, 1e-3, [](double t) { return 1.0 + 0.3 * std::sin(2.0 * pi * 0.4 * t); });
  EXPECT_THAT(analysed(record).remarks, has_remark("never becomes steady"));
}

TEST(RelayRecord, ARecordShorterThanASegmentIsOneSegmentAndSaysSo) {
  const RelayReading result = analysed(relay_record(5000, 5.0, 5.0, 1e-3));
  EXPECT_EQ(result.segments, 1U);
  EXPECT_NEAR(result.line_spacing, 2.0 * pi * 1000.0 / 5000.0, 1e-9);
  EXPECT_NEAR(result.frequency, 2.0 * pi * 5.0, 0.51 * result.line_spacing);
  EXPECT_THAT(result.remarks, has_remark("the steady part has 5000 samples, less than a segment of 8192"));
}

TEST(RelayRecord, DriftAndCoarseEncoderAreRemarked) {
  Record drifting = relay_record(20000, 5.0, 5.0, 1e-3);
  for (std::size_t k = 0; k < drifting.position.size(); ++k) drifting.position[k] += 5e-8 * static_cast<double>(k);
  EXPECT_THAT(analysed(drifting).remarks, has_remark("the position drifts by"));
  Record coarse = relay_record(20000, 5.0, 5.0, 1e-3);
  for (double& each : coarse.position) each = 5e-4 * std::round(each / 5e-4);
  EXPECT_THAT(analysed(coarse).remarks, has_remark("few steps of the encoder"));
}

TEST(RelayRecord, AnotherOscillationRidingOnItLeavesNoCycleFrequency) {
  Record record = relay_record(20000, 4.0, 5.0, 1e-3);
  for (std::size_t k = 0; k < record.position.size(); ++k) {
    record.position[k] += 0.9e-3 * std::sin(2.0 * pi * 50.3 * period * static_cast<double>(k));
  }
  const RelayReading result = analysed(record);
  EXPECT_NEAR(result.frequency, 2.0 * pi * 4.0, result.line_spacing);
  if (result.cycle_frequency) {
    EXPECT_NEAR(*result.cycle_frequency, result.frequency, result.line_spacing);
  }
}

TEST(RelayRecord, SaysWhyThereIsNoOscillation) {
  const std::vector<double> zeros(20000, 0.0);
  const Record good = relay_record(20000, 5.0, 5.0, 1e-3);
  EXPECT_EQ(failure({zeros, good.position}).code, FindingCode::force_never_changes);
  EXPECT_EQ(failure({good.force, zeros}).code, FindingCode::position_never_changes);
  EXPECT_EQ(text(failure(relay_record(20, 5.0, 5.0, 1e-3))), "the record has 20 samples; at least 64");
  EXPECT_EQ(text(failure(relay_record(20000, 0.5, 5.0, 1e-3))),
            "the record holds no oscillation of at least 16 cycles; record for longer");
  Record stuck = good;
  std::fill(stuck.force.begin() + 9000, stuck.force.end(), 5.0);
  EXPECT_EQ(failure(stuck).code, FindingCode::force_stops_changing);
  EXPECT_DOUBLE_EQ(failure(stuck).evidence.front().value, 10.0);
  stuck = good;
  std::fill(stuck.position.begin() + 9000, stuck.position.end(), 1e-4);
  EXPECT_EQ(failure(stuck).code, FindingCode::position_stops_changing);
}

TEST(RelayRecord, NoiseIsNoOscillation) {
  for (const unsigned seed : {1U, 2U, 3U, 4U}) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> noise;
    Record record;
    for (int k = 0; k < 20000; ++k) {
      record.force.push_back(noise(random));
      record.position.push_back(noise(random));
    }
    EXPECT_EQ(failure(record).code, FindingCode::no_frequency_stands_out);
  }
}

TEST(RelayRecord, AnyFiniteRecordGetsAnAnswerOrAReason) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    SCOPED_TRACE(trial);
    const auto samples = static_cast<std::size_t>(1 + random() % 600);
    Record record;
    double position = 0.0;
    const double memory = uniform(random);
    for (std::size_t k = 0; k < samples; ++k) {
      record.force.push_back(trial % 3 == 0 ? std::copysign(1.0, uniform(random)) : uniform(random));
      position = memory * position + record.force.back();
      record.position.push_back(trial % 5 == 0 ? 1e300 * position : position);
    }
    RelayAnalysisOptions options;
    options.segment_length = 64;
    const auto result = analyse_relay_record(record.force, record.position, period, options);
    if (!result) {
      EXPECT_NE(result.error().why.code, FindingCode::stated);
      continue;
    }
    EXPECT_GT(result->frequency, 0.0);
    EXPECT_LE(result->frequency, pi / period);
    EXPECT_LE(result->steady_from + result->steady_samples, samples);
  }
}

TEST(RelayRecord, RefusesWhatIsNoRecord) {
  const Record good = relay_record(20000, 5.0, 5.0, 1e-3);
  const auto refuses = [](const Record& record, double sampling_period, const RelayAnalysisOptions& options) {
    EXPECT_THROW((void)analyse_relay_record(record.force, record.position, sampling_period, options), Error);
  };
  Record bad = good;
  bad.position.pop_back();
  refuses(bad, period, {});
  bad = good;
  bad.force[7] = std::numeric_limits<double>::quiet_NaN();
  refuses(bad, period, {});
  bad = good;
  bad.position[7] = std::numeric_limits<double>::infinity();
  refuses(bad, period, {});
  refuses(good, 0.0, {});
  refuses(good, std::nan(""), {});
  refuses(good, period, {.segment_length = 10});
  refuses(good, period, {.steady_tolerance = 0.0});
  refuses(good, period, {.steady_tolerance = std::nan("")});
}

}  // namespace
}  // namespace zwidth
