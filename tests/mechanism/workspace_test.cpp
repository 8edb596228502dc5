// The limits over a workspace, beside those of each pose and direction alone.

#include "zwidth/workspace.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "mechanism/random_mechanism.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/wall_filter.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/grasp_limit.hpp"

namespace zwidth {
namespace {

constexpr double of_reference = 1e-8;           // of planar_arm.json
constexpr double of_reference_any_user = 1e-5;  // likewise
constexpr double of_quick_limits = 1e-4;        // DirectionLimits::any_user
constexpr double of_confirmed_crossover = 2e-6;

MechanismFile workspace_arm(double shoulder, double elbow) {
  return {.path = ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.xml",  // without ranges of joints
          .tip = "tip",
          .encoders = {},
          .pose = {{"shoulder", shoulder}, {"elbow", elbow}},
          .transmissions = {}};
}

Device workspace_device(const MechanismFile& file, double delay = 0.0,
                        const Eigen::Vector3d& normal = {1.0, 0.0, 0.0}) {
  DeviceParameters parameters;
  parameters.name = "mechanism";
  parameters.loop.sampling_period = 1e-3;
  parameters.loop.delay = delay;
  parameters.mechanism = MechanismDirection{file, {normal.x(), normal.y(), normal.z()}};
  return device_of_mechanism(std::move(parameters));
}

Device phantom_device() {
  MechanismFile file{.path = ZWIDTH_SOURCE_DIR "/devices/mechanisms/phantom_premium.xml",
                     .tip = "tip",
                     .encoders = {},
                     .pose = {{"base", 0.35}, {"upper", 0.26}, {"fore", 0.17}},
                     .transmissions = {}};
  for (const char* joint : {"base", "upper", "fore"}) {
    file.transmissions.push_back({joint, joint == std::string("base") ? 13.3 : 11.2, 1.03e-6, 1e-6, 100.0, 0.02});
  }
  return workspace_device(file);
}

TipMotion tip_at(const Device& device, const JointPositions& pose) {
  return tip_motion(MechanismModel(device.parameters().mechanism->mechanism).at(pose));
}

double any_user_of(const NormalLimits& limits) { return std::min(limits.stiffness, limits.any_grasp->stiffness); }

bool has_finding(const Workspace& found, FindingCode code) {
  return std::ranges::any_of(found.remarks,
                             [code](const Remark& each) { return each.finding && each.finding->code == code; });
}

TEST(Workspace, PlanarArmReference) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.json");
  int normals = 0;
  int any_user = 0;
  for (const nlohmann::json& each : nlohmann::json::parse(file)) {
    if (each["normal"].is_null()) continue;
    ++normals;
    SCOPED_TRACE(each.dump());
    const Eigen::Vector3d normal(each["normal"][0], each["normal"][1], each["normal"][2]);
    const Workspace found = workspace(workspace_device(workspace_arm(0.1, 1.0), each["delay"]),
                                      {.poses = {{{"shoulder", each["pose"][0]}, {"elbow", each["pose"][1]}}},
                                       .normals = {normal},
                                       .any_user = each.contains("any_user")});
    EXPECT_TRUE(found.trust.sound());
    EXPECT_EQ(found.directions, 1U);
    ASSERT_TRUE(found.least.has_value());
    EXPECT_NEAR(found.least->stiffness / each["critical_stiffness"].get<double>(), 1.0, of_reference);
    EXPECT_NEAR(found.poses[0].directions[0].nobody / found.least->stiffness, 1.0, of_confirmed_crossover);
    EXPECT_EQ(found.least_any_user.has_value(), each.contains("any_user"));
    if (!found.least_any_user) continue;
    ++any_user;
    const nlohmann::json& held = each["any_user"];
    EXPECT_NEAR(found.least_any_user->stiffness / held["critical_stiffness"].get<double>(), 1.0, of_reference_any_user);
    EXPECT_NEAR(found.least_any_user->frequency / held["frequency_rad_s"].get<double>(), 1.0, of_reference_any_user);
  }
  EXPECT_EQ(normals, 36);
  EXPECT_EQ(any_user, 9);
}

// 720 directions at each pose of the grid: none is less than the refined least, which is one of a direction.
TEST(Workspace, NoDirectionIsLessThanTheLeast) {
  const Device device = workspace_device(workspace_arm(0.3, 1.2), 2.5e-4);
  const Workspace found = workspace(device, {.grid = {{"shoulder", 0.0, 1.0, 2}, {"elbow", 0.3, 2.4, 3}}});
  ASSERT_EQ(found.poses.size(), 6U);
  EXPECT_EQ(found.tip_directions, 2U);
  EXPECT_EQ(found.directions, 72U);
  std::vector<Eigen::Vector3d> normals;
  for (int i = 0; i < 720; ++i) {
    const double angle = std::numbers::pi * i / 720.0;
    normals.emplace_back(std::cos(angle), std::sin(angle), 0.0);
  }
  double least = std::numeric_limits<double>::infinity();
  double least_any_user = least;
  for (const WorkspacePose& pose : found.poses) {
    double here = std::numeric_limits<double>::infinity();
    double here_any_user = here;
    double greatest = 0.0;
    for (const NormalLimits& each : limits_along(tip_at(device, pose.pose), device.parameters(), normals)) {
      here = std::min(here, each.stiffness);
      here_any_user = std::min(here_any_user, any_user_of(each));
      greatest = std::max(greatest, each.stiffness);
    }
    EXPECT_LE(pose.least->nobody, here * (1.0 + 1e-5));
    EXPECT_GE(pose.least->nobody, here * (1.0 - 1e-3));
    EXPECT_LE(*pose.least_any_user->any_user, here_any_user * (1.0 + 2.0 * of_quick_limits));
    EXPECT_GE(pose.greatest->nobody, greatest * (1.0 - 1e-2));
    least = std::min(least, here);
    least_any_user = std::min(least_any_user, here_any_user);
  }
  ASSERT_TRUE(found.least && found.least_any_user);
  EXPECT_NEAR(found.least->stiffness / least, 1.0, 1e-3);
  EXPECT_NEAR(found.least_any_user->stiffness / least_any_user, 1.0, 1e-3);
  EXPECT_TRUE(found.least->limited_by.has_value());
  EXPECT_TRUE(has_finding(found, FindingCode::workspace_of_tried_poses));
  EXPECT_TRUE(has_finding(found, FindingCode::any_grasp_scanned));
}

TEST(Workspace, InSpaceNoDirectionIsLessThanTheLeast) {
  const Device device = phantom_device();
  const Workspace found = workspace(device, {.poses = {{}}, .directions = 32});
  ASSERT_EQ(found.poses.size(), 1U);
  EXPECT_EQ(found.tip_directions, 3U);
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> normals;
  for (int i = 0; i < 1000; ++i) normals.emplace_back(normal(random), normal(random), normal(random));
  double least = std::numeric_limits<double>::infinity();
  double least_any_user = least;
  for (const NormalLimits& each : limits_along(tip_at(device, {}), device.parameters(), normals)) {
    least = std::min(least, each.stiffness);
    least_any_user = std::min(least_any_user, any_user_of(each));
  }
  EXPECT_LE(found.least->stiffness, least * (1.0 + 1e-5));
  EXPECT_LE(found.least_any_user->stiffness, least_any_user * (1.0 + of_quick_limits));
  EXPECT_GE(found.least->stiffness, 0.9 * least);
}

TEST(Workspace, IsThatOfEachDevice) {
  for (unsigned seed = 21; seed <= 26; ++seed) {
    SCOPED_TRACE(seed);
    const test::RandomMechanism mechanism =
        seed % 3 == 0 ? test::five_bar_mechanism(seed) : test::serial_mechanism(seed, 1 + static_cast<int>(seed % 3));
    MechanismFile file;
    file.text = mechanism.xml;
    file.tip = "tip";
    file.encoders = mechanism.encoders;
    file.pose = mechanism.pose;
    const Device device = workspace_device(file, mechanism.delay, mechanism.normal);
    const Workspace found = workspace(device, {.poses = {{}}, .directions = 3});
    ASSERT_EQ(found.poses.size(), 1U);
    for (const DirectionLimits& each : found.poses[0].directions) {
      const Device there = device_at(device, {}, each.normal);
      const Analysis analysis = analyze(there, {.critical_damping = false, .draws = 0});
      EXPECT_NEAR(each.nobody / analysis.limits.nobody.critical_stiffness, 1.0, of_confirmed_crossover);
      ASSERT_TRUE(each.any_user && analysis.limits.any_user);
      EXPECT_NEAR(*each.any_user / analysis.limits.any_user->critical_stiffness, 1.0, of_quick_limits);
    }
  }
}

TEST(Workspace, DoesNotDependOnThreads) {
  const Device device = workspace_device(workspace_arm(0.3, 1.2));
  WorkspaceOptions options{.grid = {{"shoulder", 0.0, 0.5, 2}, {"elbow", 0.5, 2.0, 3}}, .directions = 5};
  options.stiffness = 500.0;
  options.threads = 1;
  const Workspace one = workspace(device, options);
  options.threads = 3;
  const Workspace three = workspace(device, options);
  ASSERT_EQ(one.poses.size(), three.poses.size());
  for (std::size_t i = 0; i < one.poses.size(); ++i) {
    ASSERT_EQ(one.poses[i].directions.size(), 5U);
    for (std::size_t j = 0; j < 5; ++j) {
      EXPECT_EQ(one.poses[i].directions[j].nobody, three.poses[i].directions[j].nobody);
      EXPECT_EQ(one.poses[i].directions[j].any_user, three.poses[i].directions[j].any_user);
    }
    EXPECT_EQ(one.poses[i].least->normal, three.poses[i].least->normal);
  }
  EXPECT_EQ(one.least->stiffness, three.least->stiffness);
  ASSERT_EQ(one.quantiles.size(), 7U);
  std::vector<double> limits;
  for (const WorkspacePose& pose : one.poses) {
    for (const DirectionLimits& each : pose.directions) limits.push_back(each.nobody);
  }
  EXPECT_EQ(one.quantiles.front().nobody, *std::ranges::min_element(limits));
  EXPECT_EQ(one.quantiles.back().nobody, *std::ranges::max_element(limits));
  const auto reach = std::ranges::count_if(limits, [](double each) { return each >= 500.0; });
  EXPECT_NEAR(one.share_at_least->nobody, static_cast<double>(reach) / 30.0, 1e-12);
}

TEST(Workspace, PointsAreReachedOrReported) {
  const Device device = workspace_device(workspace_arm(0.3, 1.2));
  const Workspace found = workspace(
      device, {.points = {{0.3, 0.1, 0.0}, {2.0, 0.0, 0.0}, {0.2, -0.2, 0.0}}, .directions = 2, .any_user = false});
  ASSERT_EQ(found.poses.size(), 2U);
  EXPECT_EQ(found.poses[0].point, 0U);
  EXPECT_EQ(found.poses[1].point, 2U);
  EXPECT_LT((found.poses[0].tip - Eigen::Vector3d(0.3, 0.1, 0.0)).norm(), 1e-9);
  EXPECT_LT((found.poses[1].tip - Eigen::Vector3d(0.2, -0.2, 0.0)).norm(), 1e-9);
  ASSERT_EQ(found.unreached.size(), 1U);
  EXPECT_EQ(found.unreached[0].point, 1U);
  EXPECT_NEAR(found.unreached[0].short_of, 1.55, 1e-6);
  EXPECT_TRUE(has_finding(found, FindingCode::workspace_points_not_reached));
  EXPECT_FALSE(found.least_any_user.has_value());
  const Workspace none = workspace(device, {.points = {{2.0, 0.0, 0.0}}});
  EXPECT_TRUE(none.trust.refused());
  EXPECT_FALSE(none.least.has_value());
}

TEST(Workspace, ASingularPoseIsReported) {
  const Device device = workspace_device(workspace_arm(0.3, 1.2));
  const Workspace found = workspace(device, {.grid = {{"elbow", 0.0, 1.0, 2}}, .directions = 4, .any_user = false});
  ASSERT_EQ(found.poses.size(), 2U);
  EXPECT_EQ(found.poses[0].directions.size(), 1U);
  ASSERT_EQ(found.poses[0].refused.size(), 1U);
  EXPECT_EQ(found.poses[0].refused[0].problem.code, ProblemCode::tip_does_not_move);
  EXPECT_NEAR(std::abs(found.poses[0].refused[0].normal.dot(Eigen::Vector3d(std::cos(0.3), std::sin(0.3), 0.0))), 1.0,
              1e-9);
  EXPECT_EQ(found.refused_directions, 1U);
  EXPECT_EQ(found.refused_poses, 0U);
  EXPECT_TRUE(has_finding(found, FindingCode::workspace_directions_refused));
  const Workspace along =
      workspace(device, {.grid = {{"elbow", 0.0, 1.0, 2}}, .normals = {{std::cos(0.3), std::sin(0.3), 0.0}}});
  ASSERT_TRUE(along.poses[0].problem.has_value());
  EXPECT_EQ(along.poses[0].problem->code, ProblemCode::tip_does_not_move);
  EXPECT_EQ(along.refused_poses, 1U);
  EXPECT_TRUE(has_finding(along, FindingCode::workspace_poses_refused));
  EXPECT_EQ(along.least->pose, 1U);
}

// Ever less the tip moves along the arm: the limit there rises, and the least stays.
TEST(Workspace, BesideASingularPoseNothingBreaks) {
  const Device device = workspace_device(workspace_arm(0.3, 1.2));
  std::vector<JointPositions> poses;
  for (const double elbow : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9}) poses.push_back({{"elbow", elbow}});
  const Workspace found = workspace(device, {.poses = poses, .directions = 6});
  EXPECT_TRUE(found.trust.sound());
  double greatest = 0.0;
  for (const WorkspacePose& pose : found.poses) {
    ASSERT_TRUE(pose.least && pose.least_any_user);
    EXPECT_NEAR(pose.least->nobody / found.poses[0].least->nobody, 1.0, 2e-2);
    if (pose.directions.size() == 1U) continue;
    EXPECT_EQ(pose.directions.size(), 6U);
    EXPECT_GE(pose.greatest->nobody, greatest);
    greatest = pose.greatest->nobody;
  }
  EXPECT_EQ(found.poses.back().refused.size(), 1U);
}

// A slide that nothing drives lets the tip float: walls across it are known, one by one, and along it none.
TEST(Workspace, WhatMotorsDoNotPushIsRefusedByDirection) {
  MechanismFile file;
  file.tip = "tip";
  file.text =
      R"(<mujoco><compiler angle="radian" autolimits="true"/><worldbody><body><joint name="one" axis="0 0 1" damping="0.01"/>
    <inertial pos="0.1 0 0" mass="0.1" diaginertia="1e-4 1e-4 1e-4"/><body pos="0.2 0 0"><joint name="two" axis="0 0 1" damping="0.01"/>
    <inertial pos="0.1 0 0" mass="0.1" diaginertia="1e-4 1e-4 1e-4"/><body pos="0.2 0 0"><joint name="float" type="slide" axis="0 0 1"
    damping="0.1"/><inertial pos="0 0 0" mass="0.01" diaginertia="1e-6 1e-6 1e-6"/><site name="tip"/></body></body></body></worldbody>
    <actuator><motor joint="one"/><motor joint="two"/></actuator></mujoco>)";
  file.pose = {{"one", 0.2}, {"two", 0.9}};
  const Device device = workspace_device(file);
  const Workspace found =
      workspace(device, {.poses = {{}}, .normals = {{1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, 1.0, 0.0}}});
  ASSERT_EQ(found.poses[0].directions.size(), 2U);
  EXPECT_EQ(found.poses[0].directions[0].nobody, critical_stiffness(device).stiffness);
  EXPECT_TRUE(found.poses[0].directions[0].any_user.has_value());
  ASSERT_EQ(found.poses[0].refused.size(), 1U);
  EXPECT_EQ(found.poses[0].refused[0].problem.code, ProblemCode::tip_not_determined_by_encoders);
}

TEST(Workspace, AWallWithFiltersIsAnsweredOneByOne) {
  DeviceParameters parameters = workspace_device(workspace_arm(0.3, 1.2)).parameters();
  parameters.wall.filters = {WallFilter{.frequency_hz = 100.0}};
  parameters.coordinates.reset();
  const Device device = device_of_mechanism(std::move(parameters));
  const Workspace found = workspace(device, {.poses = {{}}, .normals = {{1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}});
  ASSERT_EQ(found.poses[0].directions.size(), 1U);
  EXPECT_EQ(found.poses[0].directions[0].nobody, critical_stiffness(device).stiffness);
  const double any_user = absolute_stability_limit(device, virtual_damper(device)).stiffness;
  ASSERT_TRUE(found.poses[0].directions[0].any_user);
  EXPECT_NEAR(*found.poses[0].directions[0].any_user / any_user, 1.0, of_quick_limits);
  EXPECT_EQ(found.poses[0].refused.size(), 1U);
  EXPECT_TRUE(has_finding(found, FindingCode::any_grasp_scanned));
}

// A grasp is known of one rate alone: nobody's limits are answered, any user's is absent.
TEST(Workspace, ADamperInALoopOfItsOwnIsAnsweredForNobody) {
  DeviceParameters parameters = workspace_device(workspace_arm(0.3, 1.2)).parameters();
  parameters.loop.damper = LoopDamper{.sampling_period = 1e-4, .delay = {}};
  for (const double damping : {0.0, 2.0}) {
    SCOPED_TRACE(damping);
    parameters.wall.damping = damping;
    parameters.coordinates.reset();
    const Device device = device_of_mechanism(parameters);
    const Workspace found = workspace(device, {.poses = {{}}, .normals = {{1.0, 0.0, 0.0}}});
    EXPECT_TRUE(found.trust.sound());
    EXPECT_EQ(found.refused_poses, 0U);
    ASSERT_EQ(found.poses[0].directions.size(), 1U);
    const double alone = critical_stiffness(device).stiffness;
    EXPECT_NEAR(found.poses[0].directions[0].nobody / alone, 1.0, of_confirmed_crossover);
    ASSERT_TRUE(found.least);
    EXPECT_EQ(found.least->stiffness, alone);
    EXPECT_EQ(found.poses[0].directions[0].any_user.has_value(), damping == 0.0);
    EXPECT_EQ(found.least_any_user.has_value(), damping == 0.0);
    EXPECT_EQ(has_finding(found, FindingCode::any_grasp_not_known), damping > 0.0);
  }
}

TEST(Workspace, TheFilesUserIsLeftOut) {
  DeviceParameters parameters = workspace_device(workspace_arm(0.3, 1.2)).parameters();
  parameters.coordinates.reset();
  parameters.user = {.mass = 0.1, .damping = 1.0, .stiffness = 10.0};
  const Workspace held =
      workspace(device_of_mechanism(std::move(parameters)), {.poses = {{}}, .normals = {{1.0, 0.0, 0.0}}});
  const Workspace alone =
      workspace(workspace_device(workspace_arm(0.3, 1.2)), {.poses = {{}}, .normals = {{1.0, 0.0, 0.0}}});
  EXPECT_EQ(held.least->stiffness, alone.least->stiffness);
  EXPECT_TRUE(has_finding(held, FindingCode::workspace_without_user));
}

TEST(Workspace, EachOptionHasItsProblem) {
  const Device device = workspace_device(workspace_arm(0.3, 1.2));
  struct Wrong {
    WorkspaceOptions options;
    std::string member;
    ProblemCode code;
  };
  const std::vector<Wrong> wrong = {
      {{}, "grid", ProblemCode::joint_without_range},
      {{.grid = {{"wrist", 0, 1, 2}}}, "grid.0.joint", ProblemCode::no_such_part},
      {{.grid = {{"elbow", 0, 1, 0}}}, "grid.0.count", ProblemCode::count_out_of_range},
      {{.grid = {{"elbow", NAN, 1, 2}}}, "grid.0.first", ProblemCode::not_finite},
      {{.grid = {{"elbow", 0, 1, 2}, {"elbow", 0, 1, 2}}}, "grid.1.joint", ProblemCode::joint_given_twice},
      {{.grid = {{"elbow", 0, 1, 2, Motion::linear}}}, "grid.0.joint", ProblemCode::unit_of_other_joint},
      {{.poses = {{{"elbow", 1}}}, .units_of_poses = {{"elbow", Motion::linear}}},
       "poses.0",
       ProblemCode::unit_of_other_joint},
      {{.grid = {{"elbow", 0, 1, 2000}, {"shoulder", 0, 1, 2000}}, .directions = 10},
       "grid",
       ProblemCode::too_many_workspace_limits},
      {{.grid = {{"elbow", 0, 1, 2}}, .points = {{0, 0, 0}}}, "points", ProblemCode::poses_given_twice},
      {{.poses = {{{"wrist", 1.0}}}}, "poses.0", ProblemCode::no_such_part},
      {{.points = {{0, INFINITY, 0}}}, "points.0", ProblemCode::not_finite},
      {{.poses = {{}}, .normals = {{0, 0, 0}}}, "normals.0", ProblemCode::no_direction},
      {{.poses = {{}}, .directions = 1'000'000}, "directions", ProblemCode::count_out_of_range_or_zero},
      {{.poses = {{}}, .stiffness = -1.0}, "stiffness", ProblemCode::not_finite_and_positive},
      {{.poses = {{}}, .threads = 100'000}, "threads", ProblemCode::too_many_threads},
  };
  for (const Wrong& each : wrong) {
    SCOPED_TRACE(each.member);
    const std::optional<OptionProblem> found = find_problem(each.options, device);
    ASSERT_TRUE(found && found->problem);
    EXPECT_EQ(found->member, each.member);
    EXPECT_EQ(found->problem->code, each.code);
    EXPECT_FALSE(found->what.empty());
    EXPECT_THROW((void)workspace(device, each.options), Error);
  }
  DeviceParameters bodies;
  bodies.name = "one body";
  bodies.bodies = {{.name = "body", .mass = 1.0, .damping = 1.0}};
  bodies.loop.sampling_period = 1e-3;
  EXPECT_EQ(find_problem(WorkspaceOptions{}, Device(bodies))->problem->code, ProblemCode::not_a_mechanism);
  EXPECT_THROW((void)device_at(Device(bodies), {}, {1.0, 0.0, 0.0}), Error);
}

TEST(Workspace, EndsWhereProgressThrows) {
  const Device device = workspace_device(workspace_arm(0.3, 1.2));
  double last = 0.0;
  WorkspaceOptions options{.grid = {{"elbow", 0.5, 1.0, 20}}, .directions = 1, .any_user = false};
  options.progress = [&last](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  (void)workspace(device, options);
  EXPECT_EQ(last, 1.0);
  options.progress = [](double fraction) {
    if (fraction > 0.2) throw std::runtime_error("enough");
  };
  EXPECT_THROW((void)workspace(device, options), std::runtime_error);
}

// A joint that follows another has a range of its own: half of the other's.
TEST(Workspace, TakesTheRangesOfJointsThatFollow) {
  const std::string text = R"(<mujoco><compiler angle="radian" autolimits="true"/><worldbody>
    <body><joint name="one" axis="0 0 1" range="-0.2 0.2" damping="1"/><inertial pos="0 0 0" mass="0.1" diaginertia="1e-4 1e-4 1e-4"/>
      <site name="tip" pos="0.2 0 0"/></body>
    <body pos="1 0 0"><joint name="two" axis="0 0 1" range="-0.1 0.1"/><inertial pos="0 0 0" mass="0.1" diaginertia="1e-4 1e-4 1e-4"/>
    </body></worldbody><equality><joint joint1="two" joint2="one" polycoef="0 1 0 0 0"/></equality>
    <actuator><motor joint="one"/></actuator></mujoco>)";
  MechanismFile file;
  file.tip = "tip";
  file.text = text;
  file.pose = {{"one", 0.0}};
  const Device device = workspace_device(file, 0.0, {0.0, 1.0, 0.0});
  const Workspace found = workspace(device, {.normals = {{0.0, 1.0, 0.0}}, .any_user = false});
  EXPECT_EQ(found.poses.size(), 500U);  // of 1000 positions of the one
  for (const WorkspacePose& each : found.poses) EXPECT_LE(std::abs(each.joints.at(1)), 0.1 + 1e-9);
  EXPECT_EQ(found.refused_poses, 0U);
}

// A list that says a wall in several ways has the limits of each wall once.
TEST(Workspace, CountsAWallOnce) {
  const Device device = workspace_device(workspace_arm(0.3, 1.2));
  const JointPositions pose = {{"elbow", 1.2}};
  const Workspace once = workspace(device, {.poses = {pose}, .normals = {{1.0, 0.0, 0.0}, {0.6, 0.8, 0.0}}});
  const Workspace often = workspace(
      device, {.poses = {pose},
               .normals = {{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}, {3.0, 4.0, 0.0}, {2.0, 0.0, 0.0}, {-0.6, -0.8, 0.0}}});
  EXPECT_EQ(often.directions, 2U);
  ASSERT_EQ(often.poses[0].directions.size(), once.poses[0].directions.size());
  for (std::size_t i = 0; i < once.poses[0].directions.size(); ++i) {
    EXPECT_EQ(often.poses[0].directions[i].nobody, once.poses[0].directions[i].nobody);
  }
}

MechanismFile slider() {
  MechanismFile file;
  file.tip = "tip";
  file.text =
      R"(<mujoco><compiler angle="radian" autolimits="true"/><worldbody><body><joint name="along" type="slide" axis="1 0 0"
    range="-0.1 0.1" damping="1"/><inertial pos="0 0 0" mass="0.1" diaginertia="1e-4 1e-4 1e-4"/><site name="tip"/></body></worldbody>
    <actuator><motor joint="along"/></actuator></mujoco>)";
  return file;
}

// The file gives the ranges: about 1000 poses.
TEST(Workspace, TakesTheRangesOfTheFile) {
  const Workspace found = workspace(workspace_device(slider()), {.any_user = false});
  ASSERT_EQ(found.poses.size(), 1000U);
  EXPECT_EQ(found.pose_joints, std::vector<std::string>{"along"});
  EXPECT_EQ(found.poses.front().pose.at("along"), -0.1);
  EXPECT_EQ(found.poses.back().pose.at("along"), 0.1);
  EXPECT_NEAR(found.poses.back().tip.x(), 0.1, 1e-15);
  EXPECT_EQ(found.tip_directions, 1U);
  EXPECT_NEAR(found.quantiles.front().nobody / found.quantiles.back().nobody, 1.0, 1e-12);
}

TEST(Workspace, CountsPosesBeyondTheRangesOfJoints) {
  const Workspace found = workspace(workspace_device(slider()), {.poses = {{{"along", 0.05}}, {{"along", 0.2}}}});
  EXPECT_TRUE(has_finding(found, FindingCode::workspace_beyond_ranges));
  const Workspace within = workspace(workspace_device(slider()), {.poses = {{{"along", 0.05}}, {{"along", 0.1}}}});
  EXPECT_FALSE(has_finding(within, FindingCode::workspace_beyond_ranges));
}

TEST(Workspace, SaysThatAPointWallIsAskedAlongNormals) {
  DeviceParameters parameters = workspace_device(workspace_arm(0.3, 1.2)).parameters();
  parameters.coordinates.reset();
  parameters.mechanism->is_point = true;
  const Workspace found = workspace(device_of_mechanism(std::move(parameters)), {.poses = {{}}});
  EXPECT_TRUE(has_finding(found, FindingCode::workspace_along_normals));
  EXPECT_TRUE(found.least);
}

// At the stretched arm users are those beside it, and the pose is counted.
TEST(Workspace, SaysWhichPosesAreSingular) {
  const Device device = workspace_device(workspace_arm(0.3, 1.2));
  const Workspace found = workspace(device, {.grid = {{"elbow", 0.0, 1e-3, 2}}});
  ASSERT_EQ(found.poses.size(), 2U);
  const auto said = std::ranges::find_if(found.remarks, [](const Remark& each) {
    return each.finding && each.finding->code == FindingCode::workspace_poses_singular;
  });
  ASSERT_NE(said, found.remarks.end());
  EXPECT_EQ(said->finding->evidence[0].value, 1.0);
  EXPECT_EQ(said->finding->evidence[1].value, 2.0);
  ASSERT_TRUE(found.poses[0].least_any_user && found.poses[1].least_any_user);
  EXPECT_NEAR(*found.poses[0].least_any_user->any_user / *found.poses[1].least_any_user->any_user, 1.0, 2e-3);
}

TEST(Workspace, TheWorstPoseIsADevice) {
  const Device device = workspace_device(workspace_arm(0.3, 1.2));
  const Workspace found = workspace(device, {.grid = {{"elbow", 0.5, 2.0, 3}}, .directions = 4});
  const Device worst = device_at(device, found.poses[found.least->pose].pose, found.least->normal);
  EXPECT_EQ(worst.parameters().mechanism->mechanism.pose.at("shoulder"), 0.3);
  EXPECT_NEAR(critical_stiffness(worst).stiffness / found.least->stiffness, 1.0, 1e-12);
}

}  // namespace
}  // namespace zwidth
