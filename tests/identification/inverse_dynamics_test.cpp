#include "zwidth/identification/inverse_dynamics.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>
#include <string>

#include "campaign.hpp"
#include "identification/friction_body.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/recording_file.hpp"

namespace zwidth {
namespace {

constexpr double period = 1e-3;
const test::FrictionBody truth{5.4, 3.5, 1.2, -0.3};

struct Record {
  std::vector<double> force;
  std::vector<double> position;
};

struct Experiment {
  double duration = 20.0;
  double white = 0.0;        ///< standard deviation of the force that is not recorded, N
  double slow = 0.0;         ///< the same, correlated over 50 ms
  double encoder = 3.14e-6;  ///< m
  double rest = 0.0;         ///< s at the start of every 6 s in which no force is asked for
  unsigned seed = 1;
};

/// The body under a position controller that reads the encoder, its force held over each period.
Record closed_loop_record(const Experiment& experiment) {
  std::mt19937_64 generator(experiment.seed);
  std::normal_distribution<double> normal;
  test::FrictionBody body = truth;
  Record record;
  double slow = 0.0;
  double last = 0.0;
  double velocity = 0.0;
  const auto size = static_cast<std::size_t>(std::round(experiment.duration / period));
  for (std::size_t k = 0; k < size; ++k) {
    const double t = period * static_cast<double>(k);
    const double read = experiment.encoder * std::round(body.position / experiment.encoder);
    velocity += 0.3 * ((read - last) / period - velocity);
    last = read;
    constexpr double turn = 2.0 * std::numbers::pi;
    const double reference =
        0.05 * std::sin(0.7 * turn * t) + 0.03 * std::sin(1.9 * turn * t + 1.0) + 0.01 * std::sin(4.3 * turn * t + 2.0);
    const bool rests = std::fmod(t, 6.0) < experiment.rest;
    const double force = rests ? 0.0 : 8000.0 * (reference - read) - 150.0 * velocity;
    record.force.push_back(force);
    record.position.push_back(read);
    constexpr double kept = 0.98;  // e^(-1 ms / 50 ms)
    slow = kept * slow + std::sqrt(1.0 - kept * kept) * normal(generator);
    body.move(force + experiment.white * normal(generator) + experiment.slow * slow, period);
  }
  return record;
}

RigidBodyFit fitted(const Record& record, const InverseDynamicsOptions& options = {}) {
  return identify_rigid_body(record.force, record.position, period, options);
}

bool holds(const ParameterEstimate& estimate, double value) {
  return estimate.lower.value() <= value && value <= estimate.upper.value();
}

TEST(InverseDynamics, FindsTheParametersOfACleanRecordUnderFeedback) {
  const RigidBodyFit fit = fitted(closed_loop_record({}));
  EXPECT_NEAR(fit.mass.value, 5.4, 5e-4 * 5.4);
  EXPECT_NEAR(fit.viscous.value, 3.5, 5e-3 * 3.5);
  EXPECT_NEAR(fit.coulomb.value, 1.2, 5e-3 * 1.2);
  EXPECT_NEAR(fit.offset.value, -0.3, 1e-2 * 0.3);
  EXPECT_NEAR(fit.delay.value, 0.5 * period, 0.01 * period);  // of the hold
  EXPECT_LT(fit.relative_residual, 2e-3);
  EXPECT_TRUE(fit.remarks.empty());
}

TEST(InverseDynamics, IntervalsHoldTheTruthAsOftenAsTheySay) {
  // Over 600 seeds they held it in 89.5 % (the delay, which feedback biases a little) to 96 %. Of 100, fewer than 85,
  // or (were the intervals too wide) all 500 of the five together, are unlikely.
  struct Disturbance {
    double white;
    double slow;
  };
  for (const Disturbance disturbance : {Disturbance{2.0, 0.0}, Disturbance{0.5, 0.5}}) {
    std::array<int, 5> held{};
    const int seeds = test::by_tier(40, 100);
    for (unsigned seed = 1; seed <= static_cast<unsigned>(seeds); ++seed) {
      Experiment experiment;
      experiment.white = disturbance.white;
      experiment.slow = disturbance.slow;
      experiment.seed = seed;
      const RigidBodyFit fit = fitted(closed_loop_record(experiment));
      held[0] += holds(fit.mass, 5.4);
      held[1] += holds(fit.viscous, 3.5);
      held[2] += holds(fit.coulomb, 1.2);
      held[3] += holds(fit.offset, -0.3);
      held[4] += holds(fit.delay, 0.5 * period);
    }
    int all = 0;
    for (const int each : held) {
      EXPECT_GE(each, 0.85 * seeds) << "slow disturbance " << disturbance.slow;
      all += each;
    }
    EXPECT_LT(all, 5 * seeds);
  }
}

TEST(InverseDynamics, RestsAreLeftOut) {
  // At rest the force is anything up to the Coulomb friction: taken for sliding it would bias everything.
  Experiment experiment;
  experiment.rest = 3.0;
  experiment.duration = 24.0;
  const RigidBodyFit with_rests = fitted(closed_loop_record(experiment));
  EXPECT_NEAR(with_rests.mass.value, 5.4, 2e-3 * 5.4);
  EXPECT_NEAR(with_rests.coulomb.value, 1.2, 0.03 * 1.2);
  EXPECT_NEAR(with_rests.viscous.value, 3.5, 0.03 * 3.5);
  const std::vector<double> position = closed_loop_record(experiment).position;
  std::size_t moving = 0;
  for (std::size_t k = 50; k + 50 < position.size(); ++k) moving += position[k + 50] != position[k - 50] ? 1U : 0U;
  EXPECT_LT(moving, position.size() * 2 / 3);
  EXPECT_LT(with_rests.equations * with_rests.decimation, moving);
}

TEST(InverseDynamics, ALateForceIsMeasuredAndDoesNotBias) {
  // The recorder keeps the force three samples early.
  Record record = closed_loop_record({});
  record.force.erase(record.force.begin(), record.force.begin() + 3);
  record.position.resize(record.force.size());
  const RigidBodyFit fit = fitted(record);
  EXPECT_NEAR(fit.delay.value, 3.5 * period, 0.02 * period);
  EXPECT_NEAR(fit.mass.value, 5.4, 1e-3 * 5.4);
  EXPECT_NEAR(fit.viscous.value, 3.5, 0.01 * 3.5);
}

TEST(InverseDynamics, UnitsScaleAndSignsTurn) {
  const Record record = closed_loop_record({});
  const RigidBodyFit fit = fitted(record);
  Record turned = record;
  for (double& each : turned.force) each *= -4.0;
  for (double& each : turned.position) each *= -2.0;
  const RigidBodyFit other = fitted(turned);
  EXPECT_NEAR(other.mass.value, 2.0 * fit.mass.value, 1e-9);
  EXPECT_NEAR(other.viscous.value, 2.0 * fit.viscous.value, 1e-8);
  EXPECT_NEAR(other.coulomb.value, 4.0 * fit.coulomb.value, 1e-8);
  EXPECT_NEAR(other.offset.value, -4.0 * fit.offset.value, 1e-8);
  EXPECT_NEAR(*other.mass.standard_deviation, 2.0 * *fit.mass.standard_deviation, 1e-9);
  EXPECT_NEAR(std::sqrt(other.covariance(2, 2)), *other.coulomb.standard_deviation, 1e-12);
}

TEST(InverseDynamics, CutoffAndDecimationMayBeGiven) {
  Experiment experiment;
  experiment.white = 0.2;
  const Record record = closed_loop_record(experiment);
  const RigidBodyFit fit = fitted(record, {30.0, std::size_t{5}});
  EXPECT_EQ(fit.cutoff_hz, 30.0);
  EXPECT_EQ(fit.decimation, 5U);
  EXPECT_NEAR(fit.mass.value, 5.4, 5e-3 * 5.4);
  const RigidBodyFit chosen = fitted(record);
  EXPECT_GT(chosen.cutoff_hz, 4.3);  // the reference's fastest sine
  EXPECT_LT(chosen.cutoff_hz, 50.0);
  EXPECT_EQ(chosen.decimation, static_cast<std::size_t>(0.8 * 1000.0 / (2.0 * chosen.cutoff_hz)));
}

TEST(InverseDynamics, RefusesRecordsThatCannotTell) {
  const auto refused = [](const Record& record, const std::string& why, const InverseDynamicsOptions& options = {}) {
    try {
      (void)fitted(record, options);
      ADD_FAILURE() << why;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
      EXPECT_NE(std::string(error.what()).find(why), std::string::npos) << error.what();
    }
  };
  const Record good = closed_loop_record({});
  Record constant = good;
  std::fill(constant.position.begin(), constant.position.end(), 0.1);
  refused(constant, "the position is constant");
  Record one_way = good;
  for (std::size_t k = 0; k < one_way.position.size(); ++k) {
    const double t = period * static_cast<double>(k);
    one_way.position[k] = t + 0.01 * std::sin(20.0 * t);
  }
  refused(one_way, "one way only");
  Record unequal = good;
  unequal.force.pop_back();
  refused(unequal, "equally many");
  Record missing = good;
  missing.position[7] = std::numeric_limits<double>::quiet_NaN();
  refused(missing, "finite");
  refused({std::vector<double>(99, 1.0), std::vector<double>(99, 1.0)}, "at least 100");
  refused({{good.force.begin(), good.force.begin() + 300}, {good.position.begin(), good.position.begin() + 300}},
          "too short", {10.0, {}});
  refused(good, "cutoff", {500.0, {}});
  refused(good, "cutoff", {0.0, {}});
  refused(good, "decimation", {{}, std::size_t{0}});
  EXPECT_THROW((void)identify_rigid_body(good.force, good.position, 0.0), Error);
}

TEST(InverseDynamics, ASineWithoutFrictionLeavesTheDelayUntold) {
  // One frequency: inertia and damping make a force of any amplitude and phase, so a delay cannot be seen.
  Record record;
  for (std::size_t k = 0; k < 20000; ++k) {
    const double t = period * static_cast<double>(k);
    constexpr double w = 6.0;
    record.position.push_back(std::sin(w * t));
    // The held force is half a period late on average.
    const double at = t + 0.5 * period;
    record.force.push_back(-5.0 * w * w * std::sin(w * at) + 3.0 * w * std::cos(w * at));
  }
  const RigidBodyFit fit = fitted(record);
  EXPECT_FALSE(fit.delay.identifiable);
  EXPECT_EQ(fit.delay.value, 0.5 * period);
  ASSERT_EQ(fit.remarks.size(), 1U);
  EXPECT_EQ(fit.remarks[0].severity, Remark::Severity::warning);
  EXPECT_NEAR(fit.mass.value, 5.0, 1e-4);
  EXPECT_NEAR(fit.viscous.value, 3.0, 1e-3);
  EXPECT_NEAR(fit.coulomb.value, 0.0, 1e-3);
}

TEST(InverseDynamics, PublishedBenchIsReproduced) {
  // EMPS (Janot, Gautier, Brunot 2019): published 95.1089 kg, 203.5034 N s/m, 20.3935 N, -3.1648 N; force 35.15 N/V.
  const std::string path = ZWIDTH_SHARED_DIR "/data/emps/DATA_EMPS.mat";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no recordings beside the project";
  RecordingOptions options;
  options.columns = {{"vir", 35.15}, {"qm", 1.0}};
  options.time_column = "t";
  const auto recording = read_recording(path, options);
  ASSERT_TRUE(recording.has_value()) << recording.error().str();
  const RigidBodyFit fit =
      identify_rigid_body(recording->channels[0].samples, recording->channels[1].samples, recording->sampling_period);
  const auto expect = [](const ParameterEstimate& estimate, double published) {
    EXPECT_NEAR(estimate.value, published, 0.01 * std::abs(published)) << estimate.key;
    EXPECT_TRUE(holds(estimate, published)) << estimate.key;
    // Plausible: the published standard deviations are below 1 %, those that allow for correlation a few times that.
    EXPECT_LT(*estimate.standard_deviation, 0.08 * std::abs(published)) << estimate.key;
  };
  expect(fit.mass, 95.1089);
  expect(fit.viscous, 203.5034);
  expect(fit.coulomb, 20.3935);
  expect(fit.offset, -3.1648);
}

}  // namespace
}  // namespace zwidth
