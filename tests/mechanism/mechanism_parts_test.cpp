// What files say in other ways is the same mechanism; what they cannot say is refused.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "mechanism/random_mechanism.hpp"
#include "zwidth/error.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double same_limit = 1e-10;  // relative, of limits

// Two hinges in a plane; with what else the file says of the shoulder, of the elbow, and after the bodies.
std::string arm_in_mjcf(const std::string& shoulder, const std::string& elbow, const std::string& rest) {
  return fmt::format(
      R"(<mujoco><compiler angle="radian" autolimits="true"/><worldbody>)"
      R"(<body name="upper"><joint name="shoulder" axis="0 0 1" damping="2e-3" {}/>)"
      R"(<inertial pos="0.1 0 0" mass="0.15" diaginertia="1e-6 6e-4 6e-4"/>)"
      R"(<body name="fore" pos="0.2 0 0"><joint name="elbow" axis="0 0 1" damping="3e-3" {}/>)"
      R"(<inertial pos="0.12 0 0" mass="0.1" diaginertia="1e-6 5e-4 5e-4"/>)"
      R"(<body name="finger" pos="0.25 0 0"><inertial pos="0 0 0" mass="0.01" diaginertia="1e-6 1e-6 1e-6"/></body>)"
      R"(</body></body></worldbody>{}</mujoco>)",
      shoulder, elbow, rest);
}

constexpr const char* two_motors = R"(<actuator><motor joint="shoulder"/><motor joint="elbow"/></actuator>)";

// The same, without motors.
constexpr const char* arm_in_urdf = R"(<robot name="arm">
  <link name="base"/>
  <joint name="shoulder" type="continuous">
    <parent link="base"/><child link="upper"/><axis xyz="0 0 1"/><dynamics damping="2e-3" friction="0.01"/>
  </joint>
  <link name="upper">
    <inertial><origin xyz="0.1 0 0"/><mass value="0.15"/>
      <inertia ixx="1e-6" iyy="6e-4" izz="6e-4" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="elbow" type="revolute">
    <parent link="upper"/><child link="fore"/><origin xyz="0.2 0 0"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="10" velocity="10"/><dynamics damping="3e-3"/>
  </joint>
  <link name="fore">
    <inertial><origin xyz="0.12 0 0"/><mass value="0.1"/>
      <inertia ixx="1e-6" iyy="5e-4" izz="5e-4" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="wrist" type="fixed"><parent link="fore"/><child link="finger"/><origin xyz="0.25 0 0"/></joint>
  <link name="finger">
    <inertial><mass value="0.01"/><inertia ixx="1e-6" iyy="1e-6" izz="1e-6" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
</robot>)";

MechanismFile mechanism_in(std::string_view text, const std::string& suffix = ".xml") {
  const std::string path = testing::TempDir() + "mechanism_parts" + suffix;
  std::ofstream(path) << text;
  MechanismFile file;
  file.path = path;
  file.tip = "finger";
  file.pose = {{"shoulder", 0.3}, {"elbow", 1.2}};
  return file;
}

Transmission behind_joint(const std::string& joint, double ratio) {
  return {.joint = joint, .ratio = ratio, .inertia = 8e-5, .motor_damping = 2e-4};
}

double limit_of(const MechanismFile& file, const Eigen::Vector3d& normal = {0.6, -0.8, 0.0}) {
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  return critical_stiffness(device_along(at_pose(file), normal, loop)).stiffness;
}

std::optional<ProblemCode> refusal_along(const MechanismFile& file, const Eigen::Vector3d& normal) {
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  try {
    (void)device_along(at_pose(file), normal, loop);
  } catch (const Error& error) {
    if (error.problems().empty() || !error.problems().front().problem) return ProblemCode::of_the_device;
    return error.problems().front().problem->code;
  }
  return std::nullopt;
}

// A signal of an actuator is torque by its gear, and its length turns by it: no wall knows the difference.
TEST(MechanismParts, a_gear_changes_no_limit) {
  const double expected = limit_of(mechanism_in(arm_in_mjcf("", "", two_motors)));
  const std::string geared =
      R"(<actuator><motor joint="shoulder" gear="-7"/><motor joint="elbow" gear="0.2"/></actuator>)";
  EXPECT_NEAR(limit_of(mechanism_in(arm_in_mjcf("", "", geared))) / expected, 1.0, same_limit);
}

TEST(MechanismParts, armature_is_the_inertia_of_a_transmission_without_a_cable) {
  const std::string shoulder = fmt::format(R"(armature="{}")", 100.0 * 8e-5);
  const std::string elbow = fmt::format(R"(armature="{}")", 25.0 * 8e-5);
  MechanismFile armature = mechanism_in(arm_in_mjcf(shoulder, elbow, two_motors));
  const MechanismAtPose with_armature = at_pose(armature);
  MechanismFile behind = mechanism_in(arm_in_mjcf("", "", ""));
  behind.transmissions = {behind_joint("shoulder", 10.0), behind_joint("elbow", 5.0)};
  const MechanismAtPose with_transmissions = at_pose(behind);
  EXPECT_LT((with_armature.mass - with_transmissions.mass).norm(), 1e-16);
  EXPECT_EQ(with_transmissions.motors, Eigen::MatrixXd(Eigen::Vector2d(10.0, 5.0).asDiagonal()));
  EXPECT_EQ(with_transmissions.encoders, with_transmissions.motors);
  EXPECT_EQ(with_transmissions.cables.rows(), 0);
  // Two joints and two motors are damped.
  EXPECT_EQ(with_transmissions.elements.size(), 4U);
}

TEST(MechanismParts, a_stiff_cable_is_none) {
  MechanismFile rigid = mechanism_in(arm_in_mjcf("", "", ""));
  rigid.transmissions = {behind_joint("shoulder", 10.0), behind_joint("elbow", 5.0)};
  MechanismFile with_cables = rigid;
  for (Transmission& each : with_cables.transmissions) {
    each.stiffness = 1e9;
    each.damping = 1e3;
  }
  EXPECT_NEAR(limit_of(with_cables) / limit_of(rigid), 1.0, 1e-5);  // by the cables' compliance
}

// The motors set its length: no cable, but a spring that balances the arm.
TEST(MechanismParts, a_tendon_that_cannot_keep_its_length_is_a_spring) {
  const std::string tendon = R"(<tendon><fixed stiffness="3"><joint joint="elbow" coef="1"/></fixed></tendon>)";
  const MechanismFile balanced = mechanism_in(arm_in_mjcf("", "", tendon + two_motors));
  EXPECT_EQ(at_pose(balanced).cables.rows(), 0);
  const double found = limit_of(balanced);
  EXPECT_NEAR(found / limit_of(mechanism_in(arm_in_mjcf("", R"(stiffness="3")", two_motors))), 1.0, same_limit);
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.xml");
  std::string text(std::istreambuf_iterator<char>(file), {});
  const std::string between =
      R"(<fixed stiffness="2"><joint joint="shoulder" coef="0.5"/><joint joint="elbow" coef="1"/></fixed>)";
  text.insert(text.find("<fixed"), between);
  MechanismFile with_cables = mechanism_in(text);
  with_cables.tip = "tip";
  const MechanismAtPose at = at_pose(with_cables);
  EXPECT_EQ(at.cables.rows(), 2);
  EXPECT_EQ(at.elements.size(), 7U);
}

// A motor and an encoder at one joint by the file, at the other by a transmission.
TEST(MechanismParts, transmissions_stand_beside_actuators) {
  const double expected = limit_of(mechanism_in(arm_in_mjcf(R"(armature="2e-3")", R"(armature="2e-3")", two_motors)));
  const std::string one_motor = R"(<actuator><motor joint="shoulder"/></actuator>)";
  MechanismFile mixed = mechanism_in(arm_in_mjcf(R"(armature="2e-3")", "", one_motor));
  mixed.transmissions = {{.joint = "elbow", .ratio = 5.0, .inertia = 8e-5}};
  EXPECT_NEAR(limit_of(mixed) / expected, 1.0, same_limit);
}

// Cables of a closed chain's file as transmissions: the same chain.
TEST(MechanismParts, transmissions_stand_behind_closed_chains) {
  MechanismFile pantograph;
  pantograph.path = ZWIDTH_SOURCE_DIR "/devices/mechanisms/pantograph.xml";
  pantograph.tip = "tip";
  pantograph.pose = {{"theta1", 0.7}, {"theta5", 2.2}};
  std::ifstream file(pantograph.path);
  std::string text(std::istreambuf_iterator<char>(file), {});
  text.resize(text.find("  <actuator>"));
  for (std::size_t at = text.find(R"( armature="1.03e-6")"); at != std::string::npos;
       at = text.find(R"( armature="1.03e-6")")) {
    text.erase(at, std::string_view(R"( armature="1.03e-6")").size());
  }
  MechanismFile without = mechanism_in(text + "</mujoco>");
  without.tip = "tip";
  without.pose = pantograph.pose;
  without.transmissions = {{.joint = "theta1", .ratio = 1.0, .inertia = 1.03e-6},
                           {.joint = "theta5", .ratio = 1.0, .inertia = 1.03e-6}};
  EXPECT_NEAR(limit_of(without) / limit_of(pantograph), 1.0, same_limit);
}

// MuJoCo joins links that are fixed: the tip's is found all the same.
TEST(MechanismParts, urdf_is_the_mechanism_that_mjcf_is) {
  MechanismFile mjcf = mechanism_in(arm_in_mjcf(R"(frictionloss="0.01")", "", ""));
  MechanismFile urdf = mechanism_in(arm_in_urdf, ".urdf");
  for (MechanismFile* file : {&mjcf, &urdf})
    file->transmissions = {behind_joint("shoulder", 10.0), behind_joint("elbow", 5.0)};
  const MechanismAtPose expected = at_pose(mjcf);
  const MechanismAtPose found = at_pose(urdf);
  EXPECT_LT((found.mass - expected.mass).norm(), 1e-15);
  EXPECT_LT((found.tip - expected.tip).norm(), 1e-15);
  ASSERT_EQ(found.elements.size(), expected.elements.size());
  for (std::size_t i = 0; i < found.elements.size(); ++i) {
    EXPECT_EQ(found.elements[i].weights, expected.elements[i].weights);
    EXPECT_EQ(found.elements[i].damping, expected.elements[i].damping);
  }
  ASSERT_EQ(found.frictions.size(), 1U);
  EXPECT_EQ(found.frictions[0].force, 0.01);
  EXPECT_NEAR(limit_of(urdf) / limit_of(mjcf), 1.0, same_limit);
}

TEST(MechanismParts, friction_loss_is_coulomb_friction_and_changes_no_limit) {
  const std::string tendon =
      R"(<tendon><fixed frictionloss="0.3"><joint joint="shoulder" coef="1"/><joint joint="elbow" coef="-2"/></fixed></tendon>)";
  const MechanismFile rubs = mechanism_in(arm_in_mjcf(R"(frictionloss="0.02")", "", tendon + two_motors));
  const MechanismAtPose at = at_pose(rubs);
  ASSERT_EQ(at.frictions.size(), 2U);
  EXPECT_EQ(at.frictions[0].force, 0.02);
  EXPECT_EQ(at.frictions[0].weights, (std::vector<double>{1.0, 0.0}));
  EXPECT_EQ(at.frictions[1].force, 0.3);
  EXPECT_EQ(at.frictions[1].weights, (std::vector<double>{1.0, -2.0}));
  EXPECT_EQ(at.elements.size(), 2U);
  EXPECT_EQ(at.cables.rows(), 0);
  DeviceParameters loop;
  loop.loop.sampling_period = 1e-3;
  EXPECT_EQ(device_along(at, {1.0, 0.0, 0.0}, loop).parameters().coordinates->frictions.size(), 2U);
  const double with = limit_of(rubs);
  EXPECT_EQ(with, limit_of(mechanism_in(arm_in_mjcf("", "", two_motors))));
}

TEST(MechanismParts, friction_in_a_closed_chain_is_along_its_free_motions) {
  test::RandomMechanism chain = test::five_bar_mechanism(3);
  const std::string joint = R"(<joint name="left elbow")";
  chain.xml.replace(chain.xml.find(joint), joint.size(), joint + R"( frictionloss="0.05")");
  MechanismFile file = mechanism_in(chain.xml);
  file.tip = "tip";
  file.pose = chain.pose;
  const MechanismAtPose at = at_pose(file);
  ASSERT_EQ(at.frictions.size(), 1U);
  EXPECT_EQ(at.frictions[0].force, 0.05);
  EXPECT_EQ(static_cast<Eigen::Index>(at.frictions[0].weights.size()), at.mass.rows());
}

// Stretched out the tip does not move along the arm; just before, it does.
TEST(MechanismParts, singular_poses_are_refused_along_their_direction_alone) {
  MechanismFile stretched = mechanism_in(arm_in_mjcf("", "", two_motors));
  stretched.pose["elbow"] = 0.0;
  const Eigen::Vector3d along(std::cos(0.3), std::sin(0.3), 0.0);
  const Eigen::Vector3d across(-std::sin(0.3), std::cos(0.3), 0.0);
  EXPECT_EQ(refusal_along(stretched, along), ProblemCode::tip_does_not_move);
  EXPECT_EQ(refusal_along(stretched, across), std::nullopt);
  EXPECT_EQ(refusal_along(stretched, Eigen::Vector3d::UnitZ()), ProblemCode::tip_does_not_move);
  try {
    (void)device_along(at_pose(stretched), 2.0 * along, {});
    FAIL();
  } catch (const Error& error) {
    ASSERT_EQ(error.problems().size(), 1U);
    EXPECT_EQ(error.problems()[0].place.key, "mechanism.normal");
    const std::vector<Evidence>& evidence = error.problems()[0].problem->evidence;
    ASSERT_EQ(evidence.size(), 3U);
    EXPECT_EQ(evidence[0].value, 2.0 * along.x());
    EXPECT_EQ(evidence[1].value, 2.0 * along.y());
  }
  MechanismFile almost = stretched;
  almost.pose["elbow"] = 1e-3;
  EXPECT_EQ(refusal_along(almost, along), std::nullopt);
}

// Where the rods of a five-bar linkage are one line, the tip moves though no motor does.
TEST(MechanismParts, a_linkage_that_its_motors_do_not_hold_is_refused) {
  MechanismFile file;
  file.path = ZWIDTH_SOURCE_DIR "/devices/mechanisms/pantograph.xml";
  file.tip = "tip";
  // The ends of the cranks are as far apart as the two rods are long: 63 mm (cos t1 - cos t5) + 25 mm = 150 mm.
  const double turned = std::acos(0.5 * 0.125 / 0.063);
  file.pose = {{"theta1", turned}, {"theta5", std::numbers::pi - turned}};
  EXPECT_EQ(refusal_along(file, Eigen::Vector3d::UnitY()), ProblemCode::motor_or_encoder_depends);
  file.pose = {{"theta1", 0.0}, {"theta5", std::numbers::pi}};  // 151 mm
  EXPECT_EQ(refusal_along(file, Eigen::Vector3d::UnitY()), ProblemCode::loop_does_not_close);
}

// Closed at the end, 72 mm between the cranks' ends, and open by 0.4 mm on the way: the elbows there may be on either side.
TEST(MechanismParts, a_pose_beyond_ones_at_which_its_loop_is_open_is_refused) {
  MechanismFile file;
  file.path = ZWIDTH_SOURCE_DIR "/devices/mechanisms/pantograph.xml";
  file.tip = "tip";
  const double degree = std::numbers::pi / 180.0;
  file.pose = {{"theta1", 45.0 * degree}, {"theta5", -25.0 * degree}};
  EXPECT_EQ(refusal_along(file, Eigen::Vector3d::UnitY()), std::nullopt);
  file.pose = {{"theta1", -315.0 * degree}, {"theta5", 335.0 * degree}};
  EXPECT_EQ(refusal_along(file, Eigen::Vector3d::UnitY()), ProblemCode::loop_does_not_close);
}

}  // namespace
}  // namespace zwidth
