#include "zwidth/stability/grasp_limit.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "campaign.hpp"
#include "reference/planar_arm.hpp"
#include "stability/random_mechanism.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/point_wall.hpp"

namespace zwidth {
namespace {

constexpr double reference_tolerance = 1e-5;  // tests/reference/README.md

DeviceParameters loop_of(double delay) {
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  loop.loop.delay = delay;
  return loop;
}

Eigen::Vector3d random_normal(test::Draws& draws, const TipMotion& motion) {
  return (motion.tip * draws.normal(motion.tip.cols(), 1)).normalized();
}

TEST(GraspLimit, PlanarArm) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.json");
  int found = 0;
  for (const nlohmann::json& each : nlohmann::json::parse(file)) {
    if (!each.contains("any_user")) continue;
    ++found;
    SCOPED_TRACE(each.dump());
    const TipMotion motion = planar_arm::tip_motion({each["pose"][0], each["pose"][1]});
    const auto components = each["normal"].get<std::vector<double>>();
    const GraspLimit limit =
        any_grasp_limit(motion, loop_of(each["delay"].get<double>()), Eigen::Vector3d(components.data()));
    EXPECT_NEAR(limit.stiffness / each["any_user"]["critical_stiffness"].get<double>(), 1.0, reference_tolerance);
    EXPECT_NEAR(limit.frequency / each["any_user"]["frequency_rad_s"].get<double>(), 1.0, reference_tolerance);
  }
  EXPECT_EQ(found, 9);
}

// The spring that reaches the limit, from elsewhere (theory of the planar arm): it destabilises at 278.845937.
TEST(GraspLimit, ASpringAtTheTipOfThePlanarArmReachesIt) {
  TipMotion motion = planar_arm::tip_motion({0.3, 1.2});
  const Eigen::Matrix2d spring{{285.5, -45.3}, {-45.3, 1026.4}};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(spring);
  for (int i = 0; i < 2; ++i) {
    const Eigen::VectorXd along = motion.tip.topRows(2).transpose() * axes.eigenvectors().col(i);
    test::add_element(motion, along, axes.eigenvalues()(i), 0.0);
  }
  EXPECT_NEAR(normal_wall_limit(motion, loop_of(0.0), Eigen::Vector3d::UnitX()).stiffness, 278.845937, 1e-5);
}

// Property: a tip that moves along one direction alone is one axis, whose limit is shown to be the least.
TEST(GraspLimit, OfOneDirectionIsThatOfOneAxis) {
  DeviceParameters parameters;
  parameters.bodies = {{.name = "motor", .mass = 0.3, .damping = 0.1}, {.name = "handle", .mass = 5.1, .damping = 3.4}};
  parameters.links = {{.first = 0, .second = 1, .stiffness = 79.5e3, .damping = 15.0}};
  parameters.loop = {.held = 1, .sampling_period = 1e-3};
  TipMotion motion;
  motion.mass = Eigen::Vector2d(0.3, 5.1).asDiagonal();
  motion.elements = {{{1.0, 0.0}, 0.0, 0.1}, {{0.0, 1.0}, 0.0, 3.4}, {{1.0, -1.0}, 79.5e3, 15.0}};
  motion.tip = motion.sensed = motion.pushed = Eigen::MatrixXd::Zero(3, 2);
  motion.tip(0, 1) = motion.pushed(0, 0) = 1.0;
  for (const std::size_t sensed : {0U, 1U}) {
    parameters.loop.sensed = sensed;
    motion.sensed.setZero();
    motion.sensed(0, static_cast<Eigen::Index>(sensed)) = 1.0;
    for (const double delay : {0.0, 0.25e-3}) {
      parameters.loop.delay = delay;
      for (const double damping : {0.0, 20.0}) {
        DeviceParameters loop = loop_of(delay);
        loop.wall.damping = damping;
        const double of_axis = absolute_stability_limit(Device(parameters), {.damping = damping}).stiffness;
        EXPECT_NEAR(any_grasp_limit(motion, loop, Eigen::Vector3d::UnitX()).stiffness / of_axis, 1.0, 1e-8);
        const PointGraspLimit point = any_grasp_limit_of_point(motion, loop);
        EXPECT_NEAR(point.at_least / of_axis, 1.0, 1e-6);
        EXPECT_GE(point.at_most, point.at_least * (1.0 - 1e-9));
      }
    }
  }
}

// Property: no random network of masses, springs, dampers and bodies on springs beats the limit. Nobody is one. Below a limit of
// 0 there is no wall. A heavy grasp on soft springs leaves poles so near the circle that eigenvalues round them across: of
// mechanism 28, network 3, |z| - 1 is -1.9e-16 in 50 digits and 1.6e-14 here.
TEST(GraspLimit, NoRandomNetworkBeatsIt) {
  constexpr double below = 1.0 - 1e-6;
  constexpr double rounded = 1.0 + 1e-12;
  const unsigned mechanisms = test::by_tier(8U, 100U);
  const int networks = test::by_tier(25, 100);
  for (unsigned seed = 0; seed < mechanisms; ++seed) {
    SCOPED_TRACE(seed);
    const auto [motion, loop] = test::random_mechanism(seed);
    if (point_wall_limit(motion, loop).status != StiffnessStatus::finite) continue;
    test::Draws draws(1000 + seed);
    const Eigen::Vector3d normal = random_normal(draws, motion);
    const GraspLimit limit = any_grasp_limit(motion, loop, normal);
    const PointGraspLimit point = any_grasp_limit_of_point(motion, loop);
    EXPECT_LE(limit.stiffness, normal_wall_limit(motion, loop, normal).stiffness * (1.0 + 1e-9));
    EXPECT_LE(point.at_least, point_wall_limit(motion, loop).stiffness * (1.0 + 1e-9));
    EXPECT_LE(point.at_least, point.at_most * (1.0 + 1e-9));
    for (int i = 0; i < networks; ++i) {
      SCOPED_TRACE(i);
      const double frequency = std::max(limit.frequency, 1e-3 / loop.loop.sampling_period);
      const TipMotion held = test::randomly_held(motion, frequency, draws);
      if (limit.stiffness > 0.0) {
        EXPECT_LT(test::SecondRoute(held, loop, normal).radius(below * limit.stiffness), rounded);
      }
      if (point.at_least > 0.0) {
        EXPECT_LT(test::SecondRoute(held, loop, Eigen::Matrix3d::Identity()).radius(below * point.at_least), rounded);
      }
    }
  }
}

// The damper alone, late and filtered, is beaten by a grasp: no wall is stable with everyone, as the second route says of one.
TEST(GraspLimit, ADamperThatAGraspBeatsLeavesNoWall) {
  const auto [motion, loop] = test::random_mechanism(64);
  test::Draws draws(1064);
  const Eigen::Vector3d normal = random_normal(draws, motion);
  EXPECT_EQ(any_grasp_limit(motion, loop, normal).stiffness, 0.0);
  const PointGraspLimit point = any_grasp_limit_of_point(motion, loop);
  EXPECT_EQ(point.at_least, 0.0);
  EXPECT_EQ(point.at_most, 0.0);
  double largest = 0.0;
  for (int i = 0; i < 5; ++i) {
    const TipMotion held = test::randomly_held(motion, 0.0, draws);
    largest = std::max(largest, test::SecondRoute(held, loop, normal).radius(0.0));
  }
  EXPECT_GT(largest, 1.0);
}

TEST(GraspLimit, NothingDampedIsNoWallForAnyone) {
  TipMotion motion = planar_arm::tip_motion({0.3, 1.2});
  for (Coordinates::Element& each : motion.elements) each.damping = 0.0;
  std::erase_if(motion.elements, [](const Coordinates::Element& each) { return each.stiffness == 0.0; });
  EXPECT_EQ(any_grasp_limit(motion, loop_of(0.0), Eigen::Vector3d::UnitX()).stiffness, 0.0);
  EXPECT_EQ(any_grasp_limit_of_point(motion, loop_of(0.0)).at_most, 0.0);
}

// Property: many normals at once have the limits that each has alone.
TEST(LimitsAlong, AreThoseOfEachNormal) {
  for (unsigned seed = 0; seed < test::by_tier(8U, 200U); ++seed) {
    SCOPED_TRACE(seed);
    const auto [motion, loop] = test::random_mechanism(seed);
    test::Draws draws(seed);
    std::vector<Eigen::Vector3d> normals;
    for (int i = 0; i < 5; ++i) normals.push_back(random_normal(draws, motion));
    const std::vector<NormalLimits> limits = limits_along(motion, loop, normals);
    ASSERT_EQ(limits.size(), normals.size());
    for (std::size_t i = 0; i < normals.size(); ++i) {
      const PointWallLimit alone = normal_wall_limit(motion, loop, normals[i]);
      EXPECT_EQ(limits[i].status, alone.status);
      if (alone.status == StiffnessStatus::finite) {
        EXPECT_NEAR(limits[i].stiffness / alone.stiffness, 1.0, 1e-8);
      }
      const double any = any_grasp_limit(motion, loop, normals[i]).stiffness;
      ASSERT_TRUE(limits[i].any_grasp);
      EXPECT_NEAR(limits[i].any_grasp->stiffness, any, 1e-4 * any);
    }
  }
}

TEST(LimitsAlong, RefusesANormalAlongWhichTheTipCannotMove) {
  const TipMotion motion = planar_arm::tip_motion({0.3, 1.2});
  EXPECT_THROW((void)limits_along(motion, loop_of(0.0), {Eigen::Vector3d::UnitZ()}), Error);
  EXPECT_THROW((void)any_grasp_limit(motion, loop_of(0.0), Eigen::Vector3d::UnitZ()), Error);
}

}  // namespace
}  // namespace zwidth
