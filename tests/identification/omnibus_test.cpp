#include "identification/verdict/omnibus.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <random>
#include <vector>

#include "identification/evidence/likelihood.hpp"
#include "identification/evidence/time_evidence.hpp"
#include "identification/optimiser/minimise.hpp"
#include "identification/verdict/calibration.hpp"

namespace zwidth::internal {
namespace {

/// A body of 0.2 kg and 1 N s/m with what a rigid structure lacks.
struct RecordedBody {
  double cubic_spring = 0.0;  ///< N/m^3
  double tip_mass = 0.0;      ///< kg, on a spring that lets it swing at 60 Hz
  double controller = 0.0;    ///< N/m: the force is less by so much of the read position
};

struct RecordedMotion {
  std::vector<double> force;
  std::vector<double> position;
};

constexpr double record_period = 1e-3;  // s

/// A sweep of 2 N from 1 to 200 Hz in 3 s.
std::vector<double> sweep() {
  std::vector<double> force;
  double phase = 0.0;
  constexpr int samples = 3000;
  for (int k = 0; k < samples; ++k) {
    phase += 2.0 * std::numbers::pi * record_period * std::pow(200.0, static_cast<double>(k) / samples);
    force.push_back(2.0 * std::sin(phase));
  }
  return force;
}

/// By fine steps; with 1e-5 m of white noise.
RecordedMotion recorded(const RecordedBody& body, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> noise(0.0, 1e-5);
  constexpr int parts = 100;
  constexpr double step = record_period / parts;
  constexpr double mass = 0.2;
  const double stiffness = body.tip_mass * std::pow(2.0 * std::numbers::pi * 60.0, 2);
  const double link_damping = 0.05 * std::sqrt(stiffness * body.tip_mass);
  double x = 0.0;
  double v = 0.0;
  double tip_x = 0.0;
  double tip_v = 0.0;
  RecordedMotion record{sweep(), {}};
  for (double& each : record.force) {
    record.position.push_back(x + noise(random));
    each -= body.controller * record.position.back();
    for (int part = 0; part < parts; ++part) {
      x += 0.5 * step * v;
      tip_x += 0.5 * step * tip_v;
      const double link = stiffness * (x - tip_x) + link_damping * (v - tip_v);
      v += step * (each - v - body.cubic_spring * x * x * x - link) / mass;
      if (body.tip_mass > 0.0) tip_v += step * link / body.tip_mass;
      x += 0.5 * step * v;
      tip_x += 0.5 * step * tip_v;
    }
  }
  return record;
}

/// What a rigid body leaves of the record.
std::optional<Omnibus> left_by_rigid_body(const RecordedBody& body, unsigned seed) {
  const auto [force, position] = recorded(body, seed);
  DeviceParameters start;
  start.name = "rigid";
  start.bodies = {{.name = "motor", .mass = 0.22, .damping = 1.1}};
  start.loop.sampling_period = record_period;
  start.loop.delay = 0.1 * record_period;
  using Scale = Number::Scale;
  const std::vector<Number> numbers = {{"body.motor.mass", Scale::logarithmic, 0.22},
                                       {"body.motor.damping", Scale::not_negative, 1.0},
                                       {"loop.delay", Scale::not_negative, record_period}};
  const MotionModel model(DeviceFamily(start, numbers, {}), {}, {{force, position, record_period}}, 1);
  constexpr Eigen::Index order = 24;
  const auto evidence =
      std::make_shared<TimeEvidence>(model, std::vector<Segment>{{0, 20, force.size() - 20}}, std::vector{0.0}, order);
  const Likelihood all(numbers, {evidence});
  evidence->set_noise({Noise{.filter = {1.0}, .deviation = 1e-4}});
  auto best = minimise(all, all.start(model.family().coordinates_of(start)), {.most_steps = 20});
  for (int round = 0; best && round < 4; ++round) {
    const Eigen::Index count = evidence->numbers();
    const auto noise = evidence->noise_at(best->z.head(count), best->z.tail(best->z.size() - count));
    if (!noise) return std::nullopt;
    evidence->set_noise(*noise);
    best = minimise(all, best->z, {.most_steps = 15});
  }
  if (!best) return std::nullopt;
  const auto left = segment_residuals(*evidence, best->z);
  if (!left) return std::nullopt;
  return omnibus(*left);
}

TEST(Omnibus, HoldsWhereTheModelIsRight) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto found = left_by_rigid_body({}, seed);
    ASSERT_TRUE(found) << seed;
    EXPECT_GT(found->p, 1e-3) << seed;
    EXPECT_EQ(found->parts.size(), 2U) << seed;
  }
}

// The controller's force follows the noise of the position that it reads, and of none before.
TEST(Omnibus, HoldsInFeedback) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const auto found = left_by_rigid_body({.controller = 500.0}, seed);
    ASSERT_TRUE(found) << seed;
    EXPECT_GT(found->p, 1e-3) << seed;
  }
}

TEST(Omnibus, FindsAMissingModeInFeedback) {
  const auto found = left_by_rigid_body({.tip_mass = 0.02, .controller = 500.0}, 1);
  ASSERT_TRUE(found);
  EXPECT_LT(found->p, Calibration::least_p);
}

TEST(Omnibus, FindsACubicSpring) {
  const auto found = left_by_rigid_body({.cubic_spring = 20.0}, 1);
  ASSERT_TRUE(found);
  EXPECT_LT(found->p, Calibration::least_p);
  EXPECT_GT(found->excess, 5.0);
  EXPECT_EQ(found->clearest, Omnibus::Kind::nonlinear);
}

TEST(Omnibus, FindsAMissingModeWhereItRings) {
  const auto found = left_by_rigid_body({.tip_mass = 0.02}, 1);
  ASSERT_TRUE(found);
  EXPECT_LT(found->p, Calibration::least_p);
  EXPECT_EQ(found->clearest, Omnibus::Kind::follows_force);
  // The sweep passes 60 Hz after log 60 / log 200 of its length.
  EXPECT_NEAR(static_cast<double>(found->first) + 0.5 * static_cast<double>(found->count), 2318.0, 450.0);
}

}  // namespace
}  // namespace zwidth::internal
