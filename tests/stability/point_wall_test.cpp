#include "zwidth/stability/point_wall.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "campaign.hpp"
#include "reference/planar_arm.hpp"
#include "stability/random_mechanism.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

constexpr double reference_tolerance = 1e-8;  // closed-loop eigenvalues (tests/reference/README.md)

TEST(PointWall, PlanarArmInAllDirectionsAndAlongEveryNormal) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.json");
  int points = 0;
  int normals = 0;
  for (const nlohmann::json& each : nlohmann::json::parse(file)) {
    SCOPED_TRACE(each.dump());
    const TipMotion motion = planar_arm::tip_motion({each["pose"][0], each["pose"][1]});
    DeviceParameters loop;
    loop.loop.sampling_period = 1e-3;
    loop.loop.delay = each["delay"];
    if (each["normal"].is_null()) {
      ++points;
      const PointWallLimit limit = point_wall_limit(motion, loop);
      EXPECT_EQ(limit.status, StiffnessStatus::finite);
      EXPECT_NEAR(limit.stiffness / each["critical_stiffness"].get<double>(), 1.0, reference_tolerance);
      continue;
    }
    ++normals;
    const Eigen::Vector3d normal(each["normal"][0], each["normal"][1], each["normal"][2]);
    EXPECT_NEAR(normal_wall_limit(motion, loop, normal).stiffness / each["critical_stiffness"].get<double>(), 1.0,
                reference_tolerance);
    loop.wall.damping = each["critical_stiffness_with_damper"][0];
    EXPECT_NEAR(
        normal_wall_limit(motion, loop, normal).stiffness / each["critical_stiffness_with_damper"][1].get<double>(),
        1.0, reference_tolerance);
  }
  EXPECT_EQ(points, 6);
  EXPECT_EQ(normals, 36);
}

// Near a singular pose the wall hardly moves one direction: its pole stays within rounding of z = 1 at the least gains.
TEST(PointWall, IsKnownWhereOneDirectionHardlyMoves) {
  TipMotion motion;
  motion.mass = Eigen::Vector2d(2e-3, 3e-3).asDiagonal();
  test::add_element(motion, Eigen::Vector2d::UnitX(), 0.0, 4e-3);
  test::add_element(motion, Eigen::Vector2d::UnitY(), 0.0, 9e-2);
  motion.tip = Eigen::MatrixXd::Zero(3, 2);
  motion.tip(0, 0) = 0.2;
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  for (const double lever : {1e-3, 1e-4, 1e-5, 1e-6}) {
    SCOPED_TRACE(lever);
    motion.tip(1, 1) = lever;
    motion.sensed = motion.pushed = motion.tip;
    const PointWallLimit limit = point_wall_limit(motion, loop);
    ASSERT_EQ(limit.status, StiffnessStatus::finite);
    const PointWallLimit alone = normal_wall_limit(motion, loop, Eigen::Vector3d::UnitX());
    EXPECT_NEAR(limit.stiffness / alone.stiffness, 1.0, 1e-9);
    const test::SecondRoute route(motion, loop, Eigen::Matrix3d::Identity());
    EXPECT_LT(route.radius(limit.stiffness * (1.0 - 1e-7)), 1.0);
    EXPECT_GT(route.radius(limit.stiffness * (1.0 + 1e-7)), 1.0);
  }
}

// Property: every wall below is stable, and the limit is where the largest pole passes the circle, by a second route.
TEST(PointWall, IsThatOfClosedLoopEigenvalues) {
  constexpr double tolerance = 1e-8;
  constexpr double rounding = 2e-11;  // of |z| by the second route: seed 591 is off by 1.3e-11, in long double by 1e-13
  constexpr int walls_below = 100;
  unsigned finite = 0;
  const unsigned mechanisms = test::by_tier(40U, 1000U);
  for (unsigned seed = 0; seed < mechanisms; ++seed) {
    SCOPED_TRACE(seed);
    const auto [motion, loop] = test::random_mechanism(seed);
    const PointWallLimit limit = point_wall_limit(motion, loop);
    const test::SecondRoute route(motion, loop, Eigen::Matrix3d::Identity());
    ASSERT_NE(limit.status, StiffnessStatus::refused);
    if (limit.status != StiffnessStatus::finite) {
      EXPECT_EQ(limit.status, StiffnessStatus::none_stable);
      EXPECT_GT(route.radius(1e-3), 1.0);
      continue;
    }
    ++finite;
    for (int i = 0; i < walls_below; ++i) {
      const double share = std::pow(1e-4, static_cast<double>(i) / (walls_below - 1));
      EXPECT_LT(route.radius(share * limit.stiffness * (1.0 - 1e-7)), 1.0);
    }
    double below = limit.stiffness * (1.0 - 1e-4);
    double above = limit.stiffness * (1.0 + 1e-4);
    ASSERT_GT(route.radius(above), 1.0);
    const double growth = (route.radius(above) - route.radius(below)) * limit.stiffness / (above - below);
    while (above - below > 0.1 * tolerance * above) {
      const double middle = 0.5 * (below + above);
      (route.radius(middle) < 1.0 ? below : above) = middle;
    }
    EXPECT_NEAR(limit.stiffness / above, 1.0, tolerance + rounding / growth);
  }
  EXPECT_GT(finite, mechanisms * 9 / 10);
}

TEST(PointWall, MarginsOfAWall) {
  const TipMotion motion = planar_arm::tip_motion({0.3, 1.2});
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  loop.wall.stiffness = 100.0;
  const PointWallMargins margins = point_wall_margins(motion, loop);
  EXPECT_TRUE(margins.stable);
  EXPECT_LT(margins.spectral_radius, 1.0);
  ASSERT_TRUE(margins.stiffness_margin);
  EXPECT_NEAR(*margins.stiffness_margin, 2.5598844746532407, reference_tolerance);
  loop.wall.stiffness = 256.0;
  EXPECT_FALSE(point_wall_margins(motion, loop).stable);
  EXPECT_FALSE(point_wall_margins(motion, loop).stiffness_margin);
}

// Property: where the tip can move along one direction alone, a point is a wall along it.
TEST(PointWall, OfOneDirectionIsTheWallAlongIt) {
  TipMotion motion = planar_arm::tip_motion({0.3, 1.2});
  for (Eigen::MatrixXd* rows : {&motion.tip, &motion.sensed, &motion.pushed}) rows->row(1).setZero();
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  const PointWallLimit limit = point_wall_limit(motion, loop);
  EXPECT_NEAR(limit.stiffness / 318.8818966185982, 1.0, reference_tolerance);
  EXPECT_NEAR(std::abs(limit.direction.x()), 1.0, 1e-9);
}

TEST(PointWall, LimitsOverDampings) {
  const TipMotion motion = planar_arm::tip_motion({0.3, 1.2});
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  const std::vector<PointWallLimit> limits = point_wall_limits(motion, loop, {0.0, 2.0, 1e4});
  ASSERT_EQ(limits.size(), 3U);
  EXPECT_NEAR(limits[0].stiffness / 255.98844746532407, 1.0, reference_tolerance);
  EXPECT_GT(limits[1].stiffness, limits[0].stiffness);
  EXPECT_EQ(limits[2].status, StiffnessStatus::none_stable);
}

TEST(PointWall, RefusesWhatItDoesNotKnow) {
  const TipMotion motion = planar_arm::tip_motion({0.3, 1.2});
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  EXPECT_THROW((void)point_wall_margins(motion, loop), Error);
  DeviceParameters filtered = loop;
  filtered.wall.filters.resize(1);
  EXPECT_THROW((void)point_wall_limit(motion, filtered), Error);
  TipMotion still = motion;
  still.tip.setZero();
  EXPECT_THROW((void)point_wall_limit(still, loop), Error);
}

}  // namespace
}  // namespace zwidth
