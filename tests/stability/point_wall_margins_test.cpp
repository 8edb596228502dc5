// Margins of a wall in every direction against closed-loop poles that share nothing with the library.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include "campaign.hpp"
#include "reference/planar_arm.hpp"
#include "stability/random_mechanism.hpp"
#include "zwidth/stability/point_wall.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

constexpr double beside = 1e-6;  // relative, of a margin

double radius_with_delay(const TipMotion& motion, DeviceParameters loop, double delay) {
  loop.loop.delay += delay;
  return test::SecondRoute(motion, loop, Eigen::Matrix3d::Identity()).radius(*loop.wall.stiffness);
}

// Property: stable with any part of the margin, whole samples and fractions, and unstable beyond it.
TEST(PointWallMargins, AreThoseOfClosedLoopEigenvalues) {
  constexpr int parts = 25;
  constexpr double most_samples = 25.0;
  unsigned phases = 0;
  unsigned delays = 0;
  const unsigned mechanisms = test::by_tier(8U, 500U);
  std::vector<unsigned> seeds(mechanisms);
  std::iota(seeds.begin(), seeds.end(), 0U);
  seeds.insert(seeds.end(),
               {57U, 161U});  // poles hidden by rounding at small gains; no closed loop at the margin itself
  for (const unsigned seed : seeds) {
    SCOPED_TRACE(seed);
    auto [motion, loop] = test::random_mechanism(seed);
    const PointWallLimit limit = point_wall_limit(motion, loop);
    if (limit.status != StiffnessStatus::finite) continue;
    test::Draws draws(seed + 7000);
    const double stiffness = draws.between(0.1, 0.95) * limit.stiffness;
    loop.wall.stiffness = stiffness;
    const PointWallMargins margins = point_wall_margins(motion, loop);
    ASSERT_TRUE(margins.stable);
    ASSERT_TRUE(margins.margins_are_known);
    EXPECT_NEAR(margins.stiffness_margin.value_or(0.0) * stiffness / limit.stiffness, 1.0, 1e-8);
    const test::SecondRoute route(motion, loop, Eigen::Matrix3d::Identity());
    const double phase = margins.phase_margin.value_or(std::numbers::pi);
    for (int i = 1; i < parts; ++i) EXPECT_LT(route.radius_turned(stiffness, phase * i / parts), 1.0);
    if (margins.phase_margin) {
      ++phases;
      EXPECT_LT(route.radius_turned(stiffness, phase * (1.0 - beside)), 1.0);
      EXPECT_GT(route.radius_turned(stiffness, phase * (1.0 + beside)), 1.0);
    }
    for (const auto& [margin, side] : {std::pair{margins.gain_margin, 1.0}, {margins.lower_gain_margin, -1.0}}) {
      if (!margin) continue;
      EXPECT_LT(route.radius_turned(stiffness, 0.0, *margin * (1.0 - side * beside)), 1.0);
      EXPECT_GT(route.radius_turned(stiffness, 0.0, *margin * (1.0 + side * beside)), 1.0);
    }
    const double samples = margins.delay_margin.value_or(most_samples * loop.loop.sampling_period);
    const double delay = std::min(samples, most_samples * loop.loop.sampling_period);
    for (int i = 1; i < parts; ++i) EXPECT_LT(radius_with_delay(motion, loop, delay * i / parts), 1.0);
    if (!margins.delay_margin || delay < samples) continue;
    ++delays;
    EXPECT_LT(radius_with_delay(motion, loop, delay * (1.0 - beside)), 1.0);
    EXPECT_GT(radius_with_delay(motion, loop, delay * (1.0 + beside)), 1.0);
  }
  EXPECT_GT(phases, mechanisms * 8 / 10);
  EXPECT_GT(delays, mechanisms * 6 / 10);
}

// Where the tip moves along one direction alone, they are those of the wall along it.
TEST(PointWallMargins, OfOneDirectionAreThoseOfTheWallAlongIt) {
  constexpr double mass = 0.3;
  DeviceParameters axis;
  axis.name = "axis";
  axis.bodies = {{"motor", mass, 0.4}, {"handle", 0.2, 0.1}};
  axis.links = {{0, 1, 3000.0, 0.3}};
  axis.loop.held = 1;
  axis.loop.sampling_period = 1e-3;
  axis.loop.delay = 0.4e-3;
  axis.wall.stiffness = 150.0;
  axis.wall.damping = 1.5;
  const WallMargins one = wall_margins(Device(axis));
  TipMotion motion;
  motion.mass = Eigen::Vector2d(mass, 0.2).asDiagonal();
  test::add_element(motion, Eigen::Vector2d(1.0, 0.0), 0.0, 0.4);
  test::add_element(motion, Eigen::Vector2d(0.0, 1.0), 0.0, 0.1);
  test::add_element(motion, Eigen::Vector2d(1.0, -1.0), 3000.0, 0.3);
  motion.tip = motion.sensed = Eigen::MatrixXd::Zero(3, 2);
  motion.tip(0, 1) = motion.sensed(0, 0) = 1.0;
  motion.pushed = motion.sensed;
  const PointWallMargins point = point_wall_margins(motion, axis);
  ASSERT_TRUE(one.stable && point.stable && point.margins_are_known);
  EXPECT_NEAR(point.phase_margin.value() / one.phase_margin.value(), 1.0, 1e-9);
  EXPECT_NEAR(point.delay_margin.value() / one.delay_margin.value(), 1.0, 1e-9);
  EXPECT_NEAR(point.gain_margin.value() / one.gain_margin.value(), 1.0, 1e-9);
  EXPECT_NEAR(point.stiffness_margin.value() / one.stiffness_margin.value(), 1.0, 1e-9);
  ASSERT_EQ(point.gain_crossovers.size(), one.gain_crossovers.size());
  for (std::size_t i = 0; i < one.gain_crossovers.size(); ++i) {
    EXPECT_NEAR(point.gain_crossovers[i].frequency / one.gain_crossovers[i].frequency, 1.0, 1e-9);
    EXPECT_NEAR(point.gain_crossovers[i].phase_margin, one.gain_crossovers[i].phase_margin, 1e-9);
  }
}

TEST(PointWallMargins, OfAnUnstableWallAreNone) {
  const TipMotion motion = planar_arm::tip_motion({0.3, 1.2});
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  loop.wall.stiffness = 256.0;
  const PointWallMargins margins = point_wall_margins(motion, loop);
  EXPECT_FALSE(margins.stable);
  EXPECT_FALSE(margins.phase_margin || margins.delay_margin || margins.gain_margin || margins.stiffness_margin);
}

}  // namespace
}  // namespace zwidth
