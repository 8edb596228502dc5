// From a record to a device: the paper's locked experiment, a free device, and a bench that nobody here made.
#include "zwidth/identification/record_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <span>
#include <string>

#include "campaign.hpp"
#include "identification/synthetic_response.hpp"
#include "lhifam.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/io/recording_file.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
namespace {

// 5 N of peak force: 63 um or 20 encoder steps at rest, ten times that at resonance, on a device of some 20 N.
constexpr double amplitude = 5.0;
constexpr double force_noise = 0.005 * amplitude;
constexpr double encoder_step = 3.14e-6;

ParameterFitOptions cable_of_the_locked_device() {
  ParameterFitOptions options;
  options.locked = {"handle"};
  options.free = {"link.stiffness", "link.damping"};
  return options;
}

/// The structure knows masses and bearing, and is far off at the cable.
Device structure() {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.links[0] = {0, 1, 10e3, 1.0};
  return Device(parameters);
}

std::vector<double> chirp(double lowest_hz) {
  ExcitationOptions options;  // 20 s at 1 kHz, up to 200 Hz
  options.amplitude = amplitude;
  options.lowest_hz = lowest_hz;
  return excite(options).samples;
}

TEST(RecordFit, FindsTheCableOfTheLockedDevice) {
  const std::vector<double> force = chirp(10.0);
  const Device locked = locked_device(Device(test::lhifam_parameters()), {1});
  const auto position = test::synthetic_position(locked, force, {force_noise, encoder_step, 1});
  const RecordFit found = fit_record(structure(), force, position, 1e-3, {}, cable_of_the_locked_device());
  EXPECT_NEAR(found.fit.estimates.at(0).value, 79.5e3, 0.01 * 79.5e3);
  EXPECT_NEAR(found.fit.estimates.at(1).value, 15.0, 0.05 * 15.0);
  // The device is free again in the result.
  EXPECT_EQ(found.fit.device.bodies().size(), 2U);
  EXPECT_NEAR(critical_stiffness(found.fit.device).stiffness, 8848.709, 5.0);
}

// 200 trials: 95 % +- 2.8 (of sigma 1.54 %) is 90 to 99 %.
TEST(RecordFit, IntervalsOfTheCableHoldTheTruthInNinetyToNinetyNinePercent) {
  const int trials = test::by_tier(60, 200);
  const std::vector<double> force = chirp(10.0);
  const Device locked = locked_device(Device(test::lhifam_parameters()), {1});
  std::map<std::string, int> inside;
  for (int trial = 1; trial <= trials; ++trial) {
    const auto seed = static_cast<std::uint64_t>(trial);
    const auto position = test::synthetic_position(locked, force, {force_noise, encoder_step, seed});
    const RecordFit found = fit_record(structure(), force, position, 1e-3, {}, cable_of_the_locked_device());
    for (const ParameterEstimate& estimate : found.fit.estimates) {
      const double truth = *parameter(test::lhifam_parameters(), estimate.key);
      EXPECT_NEAR(estimate.value, truth, 0.01 * truth) << "seed " << trial << " " << estimate.key;
      if (*estimate.lower <= truth && truth <= *estimate.upper) ++inside[estimate.key];
    }
  }
  for (const char* key : {"link.0.stiffness", "link.0.damping"}) {
    EXPECT_GE(inside[key], 0.90 * trials) << key;
    EXPECT_LE(inside[key], 0.99 * trials) << key;
  }
}

DeviceParameters three_body() {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies = {{"motor", 0.3, 0.5, 0.0, 0.0}, {"arm", 0.8, 0.7, 0.0, 0.0}, {"handle", 0.4, 0.6, 0.0, 0.0}};
  device.links = {{0, 1, 80e3, 10.0}, {1, 2, 30e3, 5.0}};
  device.loop.held = 2;
  return device;
}

DeviceParameters two_body() {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies = {{"motor", 0.3, 0.6, 0.0, 0.0}, {"handle", 0.4, 0.9, 0.0, 0.0}};
  device.links = {{0, 1, 30e3, 3.0}};
  return device;
}

// A free device drifts and rings from one segment into the next; what that does to the response is taken out.
TEST(RecordFit, RecoversFreeDevicesFromAChirp) {
  for (const DeviceParameters& device : {two_body(), three_body()}) {
    SCOPED_TRACE(device.bodies.size());
    const std::vector<double> force = chirp(1.0);
    const auto position = test::synthetic_position(Device(device), force, {force_noise, encoder_step, 1});
    DeviceParameters unknown = device;
    for (Body& body : unknown.bodies) body.mass = body.damping = 1.0;
    for (Link& link : unknown.links) link.stiffness = link.damping = 1.0;
    const RecordFit found = fit_record(Device(unknown), force, position, 1e-3);
    for (const ParameterEstimate& estimate : found.fit.estimates) {
      const double truth = *parameter(device, estimate.key);
      EXPECT_TRUE(estimate.identifiable) << estimate.key;
      EXPECT_LT(std::abs(estimate.value - truth), 4.5 * *estimate.standard_deviation) << estimate.key;
      EXPECT_LT(*estimate.standard_deviation, 0.1 * truth) << estimate.key;
      if (estimate.key.ends_with("mass") || estimate.key.ends_with("stiffness")) {
        EXPECT_NEAR(estimate.value, truth, 0.003 * truth) << estimate.key;
      }
    }
  }
}

// Leakage is largest where motion rings on longest, at the resonance of 66.6 Hz, 3 Hz wide. There it passes for noise
// of some per cent; without it the stated deviations are what the errors really are.
TEST(RecordFit, LeakageIsNoLongerTakenForNoise) {
  const std::vector<double> force = chirp(1.0);
  const auto position = test::synthetic_position(Device(two_body()), force, {force_noise, encoder_step, 1});
  const RecordFit found = fit_record(Device(two_body()), force, position, 1e-3);
  const SampledPlant plant = sampled_plant(Device(two_body()));
  /// Root mean square of error / stated deviation around the resonance.
  const auto error_in_deviations = [&](const FrequencyResponse& measured) {
    double squares = 0.0;
    int count = 0;
    for (const ResponsePoint& point : measured.points) {
      const double hertz = point.frequency / (2.0 * std::numbers::pi);
      if (hertz < 60.0 || hertz > 73.0) continue;
      squares += std::norm(point.value - response(plant, point.frequency)) / point.variance;
      ++count;
    }
    return std::sqrt(squares / count);
  };
  EXPECT_LT(error_in_deviations(frequency_response(force, position, 1e-3)), 0.3);
  EXPECT_GT(error_in_deviations(found.response), 0.6);
  EXPECT_LT(error_in_deviations(found.response), 1.6);
}

class MotorBench : public testing::Test {
 protected:
  void SetUp() override {
    const std::string file = ZWIDTH_SHARED_DIR "/data/two_mass_bench/MultisineTypeA.mat";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs ../shared/data/two_mass_bench/MultisineTypeA.mat";
    RecordingOptions options;
    options.columns = {{"iq_refx", 1.0}, {"theta_mx", 1.0}};
    options.rate = 2500.0;
    auto recording = read_recording(file, options);
    ASSERT_TRUE(recording.has_value()) << recording.error().str();
    recording_ = *std::move(recording);
  }

  [[nodiscard]] RecordFit fitted(ParameterFitOptions::CriticalPoint critical_point) const {
    DeviceParameters device;  // no number of it is a guess
    device.name = "two-body";
    device.motion = Motion::rotary;
    device.bodies = {{"motor", 1.0, 1.0, 0.0, 0.0}, {"load", 1.0, 1.0, 0.0, 0.0}};
    device.links = {{0, 1, 1.0, 1.0}};
    device.loop = {0, 0, 1, 1.0 / 2500.0, 1e-3};
    device.actuator.time_constant = 1e-3;
    FrequencyResponseOptions response;
    response.excitation = FrequencyResponseOptions::Excitation::periodic;
    response.period = 2500;
    response.skip_periods = 3;
    ParameterFitOptions options;
    options.critical_point = critical_point;
    return fit_record(Device(device), recording_.channels[0].samples, recording_.channels[1].samples,
                      recording_.sampling_period, response, options);
  }

  Recording recording_;
};

// Expected values: those read off the raw data by the record's authors and by others (README of the recordings).
TEST_F(MotorBench, HasTheModesTheRatioAndTheCriticalStiffnessOfTheData) {
  const ParameterFit fit = fitted(ParameterFitOptions::CriticalPoint::held).fit;
  const DeviceParameters& device = fit.device.parameters();
  const auto hertz = [](double frequency) { return frequency / (2.0 * std::numbers::pi); };
  EXPECT_NEAR(hertz(std::sqrt(device.links[0].stiffness / device.bodies[1].mass)), 53.5, 1.0);
  const Analysis analysis = analyze(fit.device);
  ASSERT_EQ(analysis.modes.size(), 1U);
  EXPECT_NEAR(hertz(analysis.modes[0].frequency), 76.5, 1.0);
  const double ratio = device.bodies[0].mass / device.bodies[1].mass;
  EXPECT_GE(ratio, 1.0);
  EXPECT_LE(ratio, 1.15);
  EXPECT_NEAR(analysis.critical.stiffness, 301.7, 0.05 * 301.7);
  ASSERT_TRUE(analysis.critical.limit.has_value());
  EXPECT_EQ(analysis.critical.limit->limited_by.kind, Mechanism::Kind::vibration_mode);
  EXPECT_EQ(analysis.critical.limit->limited_by.mode, 1);
  ASSERT_TRUE(analysis.interval.has_value());
  EXPECT_LT(analysis.interval->lower, 301.7);
  EXPECT_GT(analysis.interval->upper, 301.7);
  EXPECT_NEAR(device.loop.delay + device.actuator.time_constant, 0.4e-3, 0.15e-3);
}

// A bench with backlash and friction is no linear two-body device to better than some per cent: said, and its critical
// stiffness without the measured point to hold on to is another.
TEST_F(MotorBench, AdmitsThatTheStructureIsNotTheWholeStory) {
  const ParameterFit held = fitted(ParameterFitOptions::CriticalPoint::held).fit;
  EXPECT_GT(held.model_error, 0.01);
  EXPECT_LT(held.model_error, 0.1);
  ASSERT_TRUE(held.stiffness_without_hold.has_value());
  const ParameterFit free = fitted(ParameterFitOptions::CriticalPoint::free).fit;
  EXPECT_FALSE(free.stiffness_without_hold.has_value());
  EXPECT_NEAR(critical_stiffness(free.device).stiffness, *held.stiffness_without_hold,
              1e-6 * *held.stiffness_without_hold);
  EXPECT_TRUE(std::ranges::any_of(held.remarks, [](const Remark& remark) {
    return remark.severity == Remark::Severity::warning && remark.what.find("unexplained") != std::string::npos;
  }));
}

// Two equal sweeps of 5 s from rest drive a light body away: how its first period differs from the second passed for noise.
// The mass was 4 % off, the critical stiffness 14 % too high within 943 to 1457 N/m, and the second of them refused.
TEST(RecordFit, WhatDiesOutOverTwoPeriodsIsNoNoise) {
  DeviceParameters rigid = test::rigid_parameters();
  rigid.bodies[0] = {"body", 0.945, 0.527, 0.0, 0.0};
  rigid.loop.delay = 0.0;
  const double truth = critical_stiffness(Device(rigid)).stiffness;
  struct Sweep {
    ExcitationKind kind;
    double lowest_hz;
    double highest_hz;
  };
  constexpr std::array sweeps{Sweep{ExcitationKind::linear_chirp, 0.2, 150.0},
                              Sweep{ExcitationKind::logarithmic_chirp, 0.7, 80.0},
                              Sweep{ExcitationKind::logarithmic_chirp, 0.3, 260.0}};
  for (const Sweep& each : std::span(sweeps).first(test::by_tier(2U, 3U))) {
    SCOPED_TRACE(each.highest_hz);
    ExcitationOptions sweep;
    sweep.kind = each.kind;
    sweep.lowest_hz = each.lowest_hz;
    sweep.highest_hz = each.highest_hz;
    sweep.amplitude = 6.0;
    sweep.duration = 5.0;
    std::vector<double> force = excite(sweep).samples;
    force.insert(force.end(), force.begin(), force.begin() + static_cast<std::ptrdiff_t>(force.size()));
    const std::vector<double> position = test::synthetic_position(Device(rigid), force, {0.0, 0.0, 1});
    const Recording recording{"", 1e-3, {{"force", force}, {"position", position}}, {}};
    const Identification found = identify(recording, Device(rigid));
    EXPECT_NEAR(found.fit.estimates.at(0).value, 0.945, 1e-3 * 0.945);
    EXPECT_NEAR(found.analysis.critical.stiffness, truth, 1e-3 * truth);
    ASSERT_TRUE(found.analysis.interval);
    EXPECT_LE(found.analysis.interval->lower, truth);
    EXPECT_GE(found.analysis.interval->upper, truth);
    EXPECT_LE(found.analysis.interval->upper - found.analysis.interval->lower, 0.02 * truth);
  }
}

}  // namespace
}  // namespace zwidth
