#include "zwidth/simulation/relay_trials.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/simulation/relay_prediction.hpp"
#include "zwidth/words/finding_text.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;

RelayOptions options_of(double amplitude, double start) {
  RelayOptions options;
  options.relay.amplitude = amplitude;
  options.start_offset = start;
  return options;
}

// The relay stands in the place of the wall: the wall's filters are not in the loop.
TEST(RelayExperiment, LeavesOutTheFiltersOfTheWall) {
  const DeviceParameters bare = test::with_delay(test::lhifam_parameters(), 4.25e-3);
  DeviceParameters filtered = bare;
  filtered.wall.filters = {{.kind = WallFilter::Kind::low_pass, .frequency_hz = 20.0}};
  RelayOptions options = options_of(5.0, 0.03);
  options.trials = 1;
  options.duration = 5.0;
  EXPECT_EQ(relay_trials(Device(filtered), options).front().position,
            relay_trials(Device(bare), options).front().position);
  const RelayPrediction with_filters = relay_prediction(Device(filtered), options.relay);
  const RelayPrediction without = relay_prediction(Device(bare), options.relay);
  EXPECT_EQ(with_filters.linear.stiffness, without.linear.stiffness);
  ASSERT_EQ(with_filters.sampled_relay.size(), without.sampled_relay.size());
  for (std::size_t i = 0; i < without.sampled_relay.size(); ++i) {
    EXPECT_EQ(with_filters.sampled_relay[i].frequency, without.sampled_relay[i].frequency);
  }
}

// Without friction and encoder a trial is one of the exact oscillations of the sampled relay, or one of unequal
// half-periods between them: within a sample of half-period.
TEST(RelayExperiment, AFrictionlessRigidDeviceSettlesAmongTheExactOscillations) {
  for (const double delay : {2e-3, 4.25e-3, 8e-3}) {
    SCOPED_TRACE(delay);
    const Device device(test::with_delay(test::rigid_parameters(), delay));
    RelayOptions options = options_of(5.0, 0.03);
    options.duration = 60.0;
    const RelayPrediction prediction = relay_prediction(device, options.relay);
    for (const RelayTrial& trial : relay_trials(device, options)) {
      ASSERT_TRUE(trial.result) << text(trial.result.error().why);
      ASSERT_TRUE(trial.result->cycle_frequency);
      const double half_period = pi / *trial.result->cycle_frequency;
      EXPECT_TRUE(std::any_of(prediction.sampled_relay.begin(), prediction.sampled_relay.end(),
                              [&](const auto& cycle) {
                                return std::abs(pi / cycle.frequency - half_period) <= 1e-3 &&
                                       std::abs(cycle.amplitude - trial.result->amplitude) < 0.02 * cycle.amplitude;
                              }))
          << *trial.result->cycle_frequency / (2.0 * pi) << " Hz, " << trial.result->amplitude << " m";
    }
  }
}

TEST(RelayExperiment, TheStiffnessIsThatOfTheSampledPlantAtTheFrequency) {
  const Device device(test::with_delay(test::rigid_parameters(), 4.25e-3));
  const SampledPlant plant = sampled_plant(device);
  for (const RelayTrial& trial : relay_trials(device, options_of(5.0, 0.03))) {
    ASSERT_TRUE(trial.result);
    const double expected = 1.0 / std::abs(response(plant, *trial.result->cycle_frequency));
    EXPECT_NEAR(trial.result->stiffness, expected, 0.01 * expected);
  }
}

TEST(RelayExperiment, ResultsDoNotDependOnTheForceWithoutEncoderAndWithFrictionInProportion) {
  DeviceParameters parameters = test::with_delay(test::reduced_pretension_parameters(), 6.25e-3);
  const auto trial_with = [&](double amplitude) {
    parameters.bodies[1].coulomb = 0.08 * amplitude;
    RelayOptions options = options_of(amplitude, 6e-3 * amplitude);
    options.trials = 1;
    return relay_trials(Device(parameters), options).front();
  };
  const RelayTrial small = trial_with(1.0);
  const RelayTrial large = trial_with(16.0);  // a power of two: the same rounding
  ASSERT_TRUE(small.result && large.result);
  EXPECT_NEAR(small.result->frequency, large.result->frequency, 1e-9);
  EXPECT_NEAR(small.result->stiffness, large.result->stiffness, 1e-6 * large.result->stiffness);
  EXPECT_NEAR(16.0 * small.result->amplitude, large.result->amplitude, 1e-6 * large.result->amplitude);
}

// Set A at 4.25 ms: on the slope from 30 mm, on the resonance from 0.1 mm.
TEST(RelayExperiment, TheStartDecidesBetweenTwoOscillations) {
  DeviceParameters parameters = test::with_delay(test::reduced_pretension_parameters(), 4.25e-3);
  parameters.bodies[1].coulomb = 0.4;
  parameters.sensor.resolution = 3.14e-6;
  const Device device(parameters);
  for (const RelayTrial& trial : relay_trials(device, options_of(5.0, 30e-3))) {
    ASSERT_TRUE(trial.result);
    EXPECT_NEAR(trial.result->frequency / (2.0 * pi), 4.5, 0.5);
  }
  for (const RelayTrial& trial : relay_trials(device, options_of(5.0, 0.1e-3))) {
    ASSERT_TRUE(trial.result);
    EXPECT_NEAR(trial.result->frequency / (2.0 * pi), 49.8, 0.3);
  }
}

TEST(RelayExperiment, EqualSeedsGiveEqualTrialsOnAnyNumberOfThreads) {
  DeviceParameters parameters = test::with_delay(test::reduced_pretension_parameters(), 3.25e-3);
  parameters.bodies[1].coulomb = 0.4;
  const Device device(parameters);
  RelayOptions options = options_of(5.0, 0.03);
  options.duration = 2.0;
  const auto first = relay_trials(device, options);
  options.threads = 1;
  const auto second = relay_trials(device, options);
  options.seed = 2;
  const auto other = relay_trials(device, options);
  ASSERT_EQ(first.size(), 4U);
  for (std::size_t i = 0; i < first.size(); ++i) {
    EXPECT_EQ(first[i].position, second[i].position);
    EXPECT_EQ(first[i].force, second[i].force);
    EXPECT_NE(first[i].position, other[i].position);
    EXPECT_LE(std::abs(first[i].start_offset / 0.03 - 1.0), 0.05);
    EXPECT_LE(std::abs(first[i].friction_factor - 1.0), 0.05);
  }
  EXPECT_NE(first[0].start_offset, first[1].start_offset);
  EXPECT_NE(first[0].friction_factor, first[1].friction_factor);
}

TEST(RelayExperiment, TakesMoreThreadsThanThereAreWithoutAWarning) {
  RelayOptions options = options_of(5.0, 0.03);
  options.duration = 0.5;
  options.threads = 33;
  testing::internal::CaptureStderr();
  EXPECT_EQ(relay_trials(Device(test::reduced_pretension_parameters()), options).size(), 4U);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(RelayExperiment, FrictionStrongerThanTheRelayEndsTheMotion) {
  DeviceParameters parameters = test::rigid_parameters();
  parameters.bodies[0].coulomb = 6.0;
  for (const RelayTrial& trial : relay_trials(Device(parameters), options_of(5.0, 0.03))) {
    ASSERT_FALSE(trial.result);
    EXPECT_EQ(trial.result.error().why.code, FindingCode::force_never_changes);
  }
}

TEST(RelayExperiment, HysteresisSlowsTheOscillation) {
  const Device device(test::with_delay(test::rigid_parameters(), 4e-3));
  RelayOptions options = options_of(5.0, 0.03);
  options.duration = 60.0;
  options.trials = 1;
  const auto plain = relay_trials(device, options);
  options.relay.hysteresis = 2e-3;
  const auto with_hysteresis = relay_trials(device, options);
  ASSERT_TRUE(plain[0].result && with_hysteresis[0].result);
  EXPECT_LT(with_hysteresis[0].result->frequency, 0.95 * plain[0].result->frequency);
  const auto cycles = relay_prediction(device, options.relay).sampled_relay;
  EXPECT_TRUE(std::any_of(cycles.begin(), cycles.end(), [&](const LimitCycle& cycle) {
    return std::abs(pi / cycle.frequency - pi / *with_hysteresis[0].result->cycle_frequency) <= 1e-3;
  }));
}

TEST(RelayExperiment, ProgressRisesToOneAndMayEndTheWork) {
  const Device device(test::with_delay(test::rigid_parameters(), 4e-3));
  RelayOptions options = options_of(5.0, 0.03);
  options.duration = 40.0;
  double last = 0.0;
  (void)relay_trials(device, options, [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  });
  EXPECT_DOUBLE_EQ(last, 1.0);
  EXPECT_THROW((void)relay_trials(device, options, [](double) { throw std::runtime_error("enough"); }),
               std::runtime_error);
}

TEST(RelayExperiment, RefusesOptionsOutsideTheirDomain) {
  const Device device(test::with_delay(test::rigid_parameters(), 2e-3));
  const auto refuses = [&](const std::string& what, auto change) {
    RelayOptions options = options_of(5.0, 0.03);
    change(options);
    EXPECT_THROW((void)relay_trials(device, options), Error) << what;
  };
  refuses("zero amplitude", [](auto& options) { options.relay.amplitude = 0.0; });
  refuses("hysteresis below 0", [](auto& options) { options.relay.hysteresis = -1e-3; });
  refuses("no trials", [](auto& options) { options.trials = 0; });
  refuses("endless start", [](auto& options) { options.start_offset = std::numeric_limits<double>::infinity(); });
  refuses("variation of 1", [](auto& options) { options.variation = 1.0; });
  refuses("NaN duration", [](auto& options) { options.duration = std::nan(""); });
  refuses("too short", [](auto& options) { options.duration = 0.01; });
  refuses("too much", [](auto& options) { options.duration = 1e6; });
  const Device late(test::with_delay(test::rigid_parameters(), 5.0));
  RelayOptions options = options_of(5.0, 0.03);
  options.duration = 4.0;
  EXPECT_THROW((void)relay_trials(late, options), Error);
  const Device rational(test::transfer_function_parameters({1}, {1, 3, 2, 0}, 1e-2));
  EXPECT_THROW((void)relay_trials(rational, options_of(1.0, 0.1)), Error);
  EXPECT_NO_THROW((void)relay_trials(rational, options_of(1.0, 0.0)));
}

TEST(RelayPrediction, ListsTheLinearCrossoversAsFirstHarmonicsWithoutFriction) {
  const Device device(test::with_delay(test::reduced_pretension_parameters(), 4.25e-3));
  const RelayPrediction prediction = relay_prediction(device, {5.0, 0.0});
  ASSERT_EQ(prediction.describing_function.size(), prediction.linear.crossovers.size());
  for (std::size_t i = 0; i < prediction.describing_function.size(); ++i) {
    const LimitCycle& cycle = prediction.describing_function[i];
    EXPECT_DOUBLE_EQ(cycle.frequency, prediction.linear.crossovers[i].frequency);
    EXPECT_DOUBLE_EQ(cycle.stiffness, prediction.linear.crossovers[i].stiffness);
    EXPECT_NEAR(cycle.amplitude, 4.0 * 5.0 / (pi * cycle.stiffness), 1e-12);
  }
}

TEST(RelayPrediction, ADeviceThatNothingDestabilisesHasNoContinuousCycle) {
  // A sampled first-order lag of slow sampling crosses at Nyquist only.
  const Device device(test::transfer_function_parameters({1}, {1, 1}, 1e-3));
  const RelayPrediction prediction = relay_prediction(device, {1.0, 0.0});
  for (const LimitCycle& cycle : prediction.sampled_relay) EXPECT_LE(cycle.frequency, pi / 1e-3 * (1.0 + 1e-12));
  EXPECT_THROW((void)relay_prediction(device, {0.0, 0.0}), Error);
}

}  // namespace
}  // namespace zwidth
