// A mechanism's file read once and looked at in many poses.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "mechanism/random_mechanism.hpp"
#include "zwidth/error.hpp"
#include "zwidth/mechanism.hpp"

namespace zwidth {
namespace {

constexpr double reached_within = 1e-9;  // m, as MechanismModel::reach() says

MechanismFile file_of_device(const std::string& name) {
  return {.path = ZWIDTH_SOURCE_DIR "/devices/mechanisms/" + name + ".xml",
          .tip = "tip",
          .encoders = {},
          .pose = {},
          .transmissions = {}};
}

MechanismFile file_of_random(const test::RandomMechanism& mechanism, const JointPositions& pose) {
  MechanismFile file;
  file.text = mechanism.xml;
  file.tip = "tip";
  file.encoders = mechanism.encoders;
  file.pose = pose;
  return file;
}

test::RandomMechanism random_mechanism(unsigned seed) {
  return seed % 4 == 3 ? test::five_bar_mechanism(seed) : test::serial_mechanism(seed, 1 + static_cast<int>(seed % 4));
}

void expect_same(const MechanismAtPose& a, const MechanismAtPose& b) {
  EXPECT_EQ(a.mass, b.mass);
  EXPECT_EQ(a.cables, b.cables);
  EXPECT_EQ(a.motors, b.motors);
  EXPECT_EQ(a.encoders, b.encoders);
  EXPECT_EQ(a.tip, b.tip);
  EXPECT_EQ(a.joint_motions, b.joint_motions);
  EXPECT_EQ(a.joints, b.joints);
  EXPECT_EQ(a.tip_position, b.tip_position);
  ASSERT_EQ(a.elements.size(), b.elements.size());
  for (std::size_t i = 0; i < a.elements.size(); ++i) {
    EXPECT_EQ(a.elements[i].weights, b.elements[i].weights);
    EXPECT_EQ(a.elements[i].stiffness, b.elements[i].stiffness);
    EXPECT_EQ(a.elements[i].damping, b.elements[i].damping);
  }
}

TEST(MechanismModel, IsAtEveryPoseWhatTheFileIsThere) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    const test::RandomMechanism mechanism = random_mechanism(seed);
    const MechanismModel model(file_of_random(mechanism, {}));
    for (const double share : {0.5, 1.0, -0.2}) {
      JointPositions pose;
      for (const auto& [joint, position] : mechanism.pose) pose[joint] = share * position;
      expect_same(model.at(pose), at_pose(file_of_random(mechanism, pose)));
    }
  }
}

// Property: what was read last is looked at again, and says what a file read anew does; of a changed text nothing stays.
TEST(MechanismModel, WhatWasReadLastIsTheFileAtAnotherPoseAndTransmission) {
  const MechanismFile other = file_of_device("planar_arm");
  for (unsigned seed = 1; seed <= 8; ++seed) {
    SCOPED_TRACE(seed);
    const test::RandomMechanism mechanism = random_mechanism(seed);
    MechanismFile file = file_of_random(mechanism, {});
    for (const double share : {0.5, 1.0, -0.2}) {
      for (const auto& [joint, position] : mechanism.pose) file.pose[joint] = share * position;
      file.transmissions = {{mechanism.pose.begin()->first, 3.0 + share, 1e-4, 1e-4, share > 0.0 ? 50.0 : 0.0, 0.01}};
      file.encoders = {mechanism.pose.begin()->first};
      (void)at_pose(file);
      const MechanismAtPose again = at_pose(file);
      (void)at_pose(other);
      expect_same(again, at_pose(file));
    }
    const MechanismAtPose before = at_pose(file);
    file.text.insert(file.text.rfind("</worldbody>"), R"(<body><joint name="new"/><geom size="0.1"/></body>)");
    EXPECT_EQ(at_pose(file).joints.size(), before.joints.size() + 1);
  }
}

TEST(MechanismModel, APoseThatIsNoNumberIsRefusedByItsJoint) {
  const MechanismModel arm(file_of_device("planar_arm"));
  const MechanismModel loop(file_of_device("pantograph"));
  for (const double no_number : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (const auto& [model, joint] : {std::pair(&arm, "elbow"), std::pair(&loop, "theta1")}) {
      try {
        (void)model->at({{joint, no_number}});
        ADD_FAILURE() << joint;
      } catch (const Error& error) {
        ASSERT_EQ(error.problems().size(), 1U);
        EXPECT_EQ(error.problems()[0].place.key, std::string("mechanism.pose.") + joint);
        ASSERT_TRUE(error.problems()[0].problem);
        EXPECT_EQ(error.problems()[0].problem->code, ProblemCode::not_finite);
      }
    }
  }
}

TEST(MechanismModel, IsAskedBySeveralThreadsAtOnce) {
  const MechanismModel model(file_of_device("pantograph"));
  const auto pose = [](int i) { return JointPositions{{"theta1", 0.6 + 0.01 * i}, {"theta5", 2.4 - 0.01 * i}}; };
  std::vector<MechanismAtPose> found(40);
  std::vector<std::thread> threads;
  for (int first = 0; first < 4; ++first) {
    threads.emplace_back([&, first] {
      for (int i = first; i < 40; i += 4) found[static_cast<std::size_t>(i)] = model.at(pose(i));
    });
  }
  for (std::thread& each : threads) each.join();
  for (int i = 0; i < 40; ++i) expect_same(found[static_cast<std::size_t>(i)], model.at(pose(i)));
}

TEST(MechanismModel, KnowsWhichJointsGiveAPose) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(MechanismModel(file_of_device("planar_arm")).pose_joints(), (Names{"shoulder", "elbow"}));
  EXPECT_EQ(MechanismModel(file_of_device("pantograph")).pose_joints(), (Names{"theta1", "theta5"}));
  MechanismFile by_motors = file_of_device("planar_arm");
  by_motors.pose = {{"motor 1", 3.0}, {"elbow", 1.0}};
  EXPECT_EQ(MechanismModel(by_motors).pose_joints(), (Names{"elbow", "motor 1"}));
}

TEST(MechanismModel, TipMovesAsItsJacobianSays) {
  const MechanismModel model(file_of_device("planar_arm"));
  const MechanismAtPose at = model.at({{"shoulder", 0.3}, {"elbow", 1.2}});
  constexpr double step = 1e-6;
  const MechanismAtPose moved = model.at({{"shoulder", 0.3 + step}, {"elbow", 1.2 - step}});
  const Eigen::VectorXd by = moved.joints - at.joints;
  EXPECT_LT((moved.tip_position - at.tip_position - at.tip * by).norm(), 1e-11);
}

TEST(MechanismModel, ReachesPoints) {
  int reached = 0;
  int asked = 0;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    SCOPED_TRACE(seed);
    const test::RandomMechanism mechanism = random_mechanism(seed);
    const MechanismModel model(file_of_random(mechanism, {}));
    const Eigen::Vector3d point = model.at(mechanism.pose).tip_position;
    const MechanismModel::Reached found = model.reach(point);
    ++asked;
    if (!found.reached) continue;
    ++reached;
    EXPECT_LT((model.at(found.pose).tip_position - point).norm(), reached_within);
  }
  EXPECT_GE(reached, asked - 2);
}

TEST(MechanismModel, SaysHowFarAPointIsOutOfReach) {
  MechanismFile file = file_of_device("planar_arm");
  file.path = ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.xml";  // the same without ranges of joints
  const MechanismModel model(file);                                 // links of 0.2 m and 0.25 m, stretched out
  const MechanismModel::Reached far = model.reach({1.0, 0.0, 0.0});
  EXPECT_FALSE(far.reached);
  EXPECT_NEAR(far.short_of, 0.55, 1e-6);
  const MechanismModel::Reached above = model.reach({0.2, 0.25, 0.1});
  EXPECT_FALSE(above.reached);
  EXPECT_NEAR(above.short_of, 0.1, 1e-6);
  const MechanismModel::Reached inwards =
      model.reach({0.3, 0.0, 0.0});  // along the stretched arm: singular to begin with
  EXPECT_TRUE(inwards.reached);
}

TEST(MechanismModel, KeepsTheRangesOfJoints) {
  MechanismFile file;
  file.tip = "tip";
  file.text =
      R"(<mujoco><compiler angle="radian" autolimits="true"/><worldbody><body><joint name="one" axis="0 0 1" range="-0.5 0.5"/>
    <inertial pos="0.1 0 0" mass="0.1" diaginertia="1e-4 1e-4 1e-4"/><body pos="0.2 0 0"><joint name="two" axis="0 0 1" range="0 2"/>
    <inertial pos="0.1 0 0" mass="0.1" diaginertia="1e-4 1e-4 1e-4"/><site name="tip" pos="0.2 0 0"/></body></body></worldbody>
    <actuator><motor joint="one"/><motor joint="two"/></actuator></mujoco>)";
  const MechanismModel model(file);
  ASSERT_EQ(model.joints().size(), 2U);
  ASSERT_TRUE(model.joints()[0].range.has_value());
  EXPECT_EQ(model.joints()[0].range->least, -0.5);
  EXPECT_EQ(model.joints()[1].range->greatest, 2.0);
  EXPECT_TRUE(model.joints()[0].is_driven);
  EXPECT_TRUE(model.reach({0.3, 0.1, 0.0}).reached);
  const MechanismModel::Reached back = model.reach({-0.3, 0.1, 0.0});
  EXPECT_FALSE(back.reached);
  EXPECT_LE(back.pose.at("one"), 0.5);
  EXPECT_LE(back.pose.at("two"), 2.0);
}

TEST(MechanismModel, RefusesWithTheKey) {
  const MechanismModel model(file_of_device("planar_arm"));
  try {
    (void)model.at({{"wrist", 1.0}});
    FAIL();
  } catch (const Error& error) {
    ASSERT_EQ(error.problems().size(), 1U);
    EXPECT_EQ(error.problems()[0].place.key, "mechanism.pose.wrist");
    EXPECT_EQ(error.problems()[0].problem->code, ProblemCode::no_such_part);
  }
  EXPECT_THROW((void)model.reach({0.0, NAN, 0.0}), Error);
}

}  // namespace
}  // namespace zwidth
