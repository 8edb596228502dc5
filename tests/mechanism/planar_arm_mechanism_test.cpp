// The arm as MuJoCo reads it, beside its equations of motion and the reference.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "reference/planar_arm.hpp"
#include "zwidth/error.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double relative_tolerance = 1e-8;  // of the reference

MechanismFile arm(double shoulder, double elbow) {
  return {.path = ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.xml",
          .tip = "tip",
          .encoders = {},
          .pose = {{"shoulder", shoulder}, {"elbow", elbow}},
          .transmissions = {}};
}

DeviceParameters loop(double delay) {
  DeviceParameters parameters;
  parameters.loop.sampling_period = 1e-3;
  parameters.loop.delay = delay;
  return parameters;
}

TEST(PlanarArmMechanism, limit_along_every_normal) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.json");
  int normals = 0;
  for (const nlohmann::json& each : nlohmann::json::parse(file)) {
    if (each["normal"].is_null()) continue;
    ++normals;
    SCOPED_TRACE(each.dump());
    const Eigen::Vector3d normal(each["normal"][0], each["normal"][1], each["normal"][2]);
    const Device device = device_along(at_pose(arm(each["pose"][0], each["pose"][1])), normal, loop(each["delay"]));
    const CriticalStiffness found = critical_stiffness(device);
    EXPECT_TRUE(found.trust.sound());
    EXPECT_NEAR(found.stiffness / each["critical_stiffness"].get<double>(), 1.0, relative_tolerance);
  }
  EXPECT_EQ(normals, 36);
}

TEST(PlanarArmMechanism, has_the_mass_matrix_of_the_equations_of_motion) {
  const MechanismAtPose found = at_pose(arm(0.3, 1.2));
  const std::vector<double> expected = planar_arm::device({0.3, 1.2}, 1.0, 0.0).coordinates->mass;
  ASSERT_EQ(found.mass.size(), 16);
  for (Eigen::Index i = 0; i < 16; ++i) EXPECT_NEAR(found.mass.data()[i], expected[static_cast<std::size_t>(i)], 1e-17);
  EXPECT_EQ(found.cables.rows(), 2);
  EXPECT_EQ(found.motors.rows(), 2);
  EXPECT_EQ(found.encoders, found.motors);
}

// The cables and motors of the file as transmissions: the same arm without them.
TEST(PlanarArmMechanism, has_the_same_limit_with_motors_behind_transmissions) {
  const MechanismAtPose whole = at_pose(arm(0.3, 1.2));
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.xml");
  std::string text(std::istreambuf_iterator<char>(file), {});
  text.resize(text.find("    <body name=\"rotor 1\""));
  const std::string path = testing::TempDir() + "planar_arm_without_motors.xml";
  std::ofstream(path) << text << "</worldbody></mujoco>";
  MechanismFile without = arm(0.3, 1.2);
  without.path = path;
  for (const auto& [joint, stiffness] : {std::pair{"shoulder", 400.0}, std::pair{"elbow", 300.0}}) {
    without.transmissions.push_back({.joint = joint,
                                     .ratio = 10.0,
                                     .inertia = 8e-5,
                                     .motor_damping = 2e-4,
                                     .stiffness = stiffness,
                                     .damping = 0.05});
  }
  const Eigen::Vector3d normal(0.6, -0.8, 0.0);
  const double expected = critical_stiffness(device_along(whole, normal, loop(0.0))).stiffness;
  EXPECT_NEAR(critical_stiffness(device_along(at_pose(without), normal, loop(0.0))).stiffness / expected, 1.0, 1e-10);
}

std::optional<ProblemCode> code_of(const MechanismFile& file, const Eigen::Vector3d& normal) {
  try {
    (void)device_along(at_pose(file), normal, loop(0.0));
  } catch (const Error& error) {
    if (!error.problems().empty() && error.problems().front().problem) return error.problems().front().problem->code;
    return ProblemCode::of_the_device;
  }
  return std::nullopt;
}

TEST(PlanarArmMechanism, is_refused_where_it_makes_no_device) {
  using enum ProblemCode;
  const Eigen::Vector3d along_x(1.0, 0.0, 0.0);
  EXPECT_EQ(code_of(arm(0.3, 1.2), along_x), std::nullopt);
  EXPECT_EQ(code_of(arm(0.3, 1.2), {0.0, 0.0, 0.0}), no_direction);
  EXPECT_EQ(code_of(arm(0.3, 1.2), {0.0, 0.0, 1.0}), tip_does_not_move);                      // out of its plane
  EXPECT_EQ(code_of(arm(0.3, 0.0), {std::cos(0.3), std::sin(0.3), 0.0}), tip_does_not_move);  // stretched out
  MechanismFile no_tip = arm(0.3, 1.2);
  no_tip.tip = "finger";
  EXPECT_EQ(code_of(no_tip, along_x), no_such_part);
  MechanismFile no_joint = arm(0.3, 1.2);
  no_joint.pose["wrist"] = 0.1;
  EXPECT_EQ(code_of(no_joint, along_x), no_such_part);
  MechanismFile one_encoder = arm(0.3, 1.2);
  one_encoder.encoders = {"motor 1"};
  EXPECT_EQ(code_of(one_encoder, along_x), tip_not_determined_by_encoders);
  MechanismFile with_elbow = arm(0.3, 1.2);
  with_elbow.encoders = {"motor 1", "motor 2", "elbow"};
  EXPECT_EQ(code_of(with_elbow, along_x), motor_or_encoder_depends);
  MechanismFile no_file = arm(0.3, 1.2);
  no_file.path = "/nowhere.xml";
  EXPECT_EQ(code_of(no_file, along_x), mechanism_file_refused);
}

}  // namespace
}  // namespace zwidth
