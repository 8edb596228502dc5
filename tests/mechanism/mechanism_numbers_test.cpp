// Numbers of the mechanism's own file that a device file or --set replaces.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "zwidth/design/parameter_sweep.hpp"
#include "zwidth/design/sensitivity.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/study_file.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/model/mechanism_key.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

std::string text_of(const std::string& path) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/" + path);
  return {std::istreambuf_iterator<char>(file), {}};
}

const std::string reference_arm = text_of("tests/reference/planar_arm.xml");

std::string device_text(const std::string& mechanism) {
  return "[mechanism]\ntext = '''\n" + mechanism +
         "'''\ntip = \"tip\"\npose = { shoulder = 0.3, elbow = 1.2 }\nnormal = [1, 0, 0]\n[loop]\nsampling_period = "
         "1e-3\n";
}

Device read(const std::string& mechanism, const std::vector<std::string>& overrides = {},
            const std::string& more = "") {
  auto device = parse_device(device_text(mechanism) + more, "arm.toml", overrides);
  if (!device) throw std::runtime_error(device.error().str());
  return *std::move(device);
}

InputError refused(const std::string& mechanism, const std::vector<std::string>& overrides,
                   const std::string& more = "") {
  const auto device = parse_device(device_text(mechanism) + more, "arm.toml", overrides);
  if (device) throw std::runtime_error("not refused");
  return device.error();
}

std::string edited(const std::string& one, const std::string& other) {
  std::string text = reference_arm;
  return text.replace(text.find(one), one.size(), other);
}

const std::string shoulder = R"(<joint name="shoulder" axis="0 0 1" damping="2e-3")";
const std::string motor = R"(<joint name="motor 1" axis="0 0 1" damping="2e-4")";
const std::string cable = R"(stiffness="400" damping="0.05")";

// The second route: the file edited by hand.
TEST(MechanismNumbers, ANumberOfTheFileIsReplacedBitForBit) {
  struct Change {
    std::string key;
    std::string value;
    std::string one;
    std::string other;
  };
  const std::vector<Change> changes = {
      {"joint.shoulder.damping", "0.01", shoulder, R"(<joint name="shoulder" axis="0 0 1" damping="0.01")"},
      {"joint.shoulder.stiffness", "0.5", shoulder, shoulder + R"( stiffness="0.5")"},
      {"joint.shoulder.armature", "1e-3", shoulder, shoulder + R"( armature="1e-3")"},
      {"joint.motor 1.armature", "2.5e-5", motor, motor + R"( armature="2.5e-5")"},
      {"tendon.cable 1.stiffness", "251.3", cable, R"(stiffness="251.3" damping="0.05")"},
      {"tendon.cable 1.stiffness", "299", cable,
       R"(stiffness="299" damping="0.05")"},  // the other is the stiffest then
      {"tendon.cable 1.damping", "0", cable, R"(stiffness="400" damping="0")"}};
  const double as_it_stands = critical_stiffness(read(reference_arm)).stiffness;
  for (const auto& [key, value, one, other] : changes) {
    SCOPED_TRACE(key);
    const Device by_hand = read(edited(one, other));
    const Device replaced = read(reference_arm, {fmt::format("mechanism.{}={}", key, value)});
    const double expected = critical_stiffness(by_hand).stiffness;
    EXPECT_NE(expected, as_it_stands);
    EXPECT_EQ(critical_stiffness(replaced).stiffness, expected);
    EXPECT_EQ(absolute_stability_limit(replaced, {}).stiffness, absolute_stability_limit(by_hand, {}).stiffness);
    // The same by number, from the device as it stands, and back.
    DeviceParameters moved = read(reference_arm).parameters();
    set_parameter(moved, "mechanism." + key, std::stod(value));
    EXPECT_EQ(critical_stiffness(Device(moved)).stiffness, expected);
    set_parameter(moved, "mechanism." + key, moved.mechanism->mechanism.file_numbers.at(key).value);
    EXPECT_EQ(critical_stiffness(Device(moved)).stiffness, as_it_stands);
    // Written and read again.
    const auto again = parse_device(write_device(replaced.parameters()), "again.toml");
    ASSERT_TRUE(again) << again.error().str();
    EXPECT_EQ(critical_stiffness(*again).stiffness, expected);
  }
}

TEST(MechanismNumbers, AreKeysOfTheDevice) {
  const Device device = read(reference_arm);
  const std::vector<std::string> keys = parameter_keys(device.parameters());
  for (const char* key : {"mechanism.joint.motor 2.damping", "mechanism.joint.elbow.stiffness",
                          "mechanism.joint.elbow.armature", "mechanism.tendon.cable 2.stiffness"}) {
    EXPECT_EQ(std::ranges::count(keys, key), 1) << key;
    EXPECT_TRUE(is_key_of_mechanism_file(key));
  }
  EXPECT_EQ(parameter(device.parameters(), "mechanism.tendon.cable 2.stiffness"), 300.0);
  EXPECT_EQ(parameter(device.parameters(), "mechanism.joint.elbow.armature"), 0.0);
  EXPECT_EQ(motion_of_key(device.parameters(), "mechanism.tendon.cable 2.stiffness"), Motion::rotary);
  EXPECT_FALSE(is_key_of_mechanism_file("mechanism.pose.elbow"));
  EXPECT_TRUE(device.parameters().mechanism->mechanism.numbers.empty());
}

TEST(MechanismNumbers, StandInTheDeviceFileWithUnits) {
  const Device device = read(reference_arm, {},
                             "[mechanism.joint.shoulder]\ndamping = \"10 mN m s/rad\"\n[mechanism.tendon]\n\"cable "
                             "1\" = { stiffness = \"0.3 kN m/rad\" }\n");
  EXPECT_NEAR(*parameter(device.parameters(), "mechanism.joint.shoulder.damping"), 0.01, 1e-15);
  EXPECT_NEAR(*parameter(device.parameters(), "mechanism.tendon.cable 1.stiffness"), 300.0, 1e-10);
  std::vector<Finding> told;
  for (const Remark& each : analyze(device, {.any_user = false, .draws = 0}).remarks) {
    if (each.finding && each.finding->code == FindingCode::mechanism_number_replaced) told.push_back(*each.finding);
  }
  ASSERT_EQ(told.size(), 2U);
  EXPECT_EQ(told[0].key, "mechanism.joint.shoulder.damping");
  EXPECT_EQ(told[1].evidence.at(1).value, 400.0);
}

// Of a slide they are linear.
TEST(MechanismNumbers, HaveTheUnitsOfTheirJoint) {
  const std::string slide = R"(<mujoco><worldbody><body name="b"><joint name="s" type="slide" axis="1 0 0"
    damping="3"/><inertial pos="0 0 0" mass="2" diaginertia="1 1 1"/><site name="tip"/></body></worldbody>
    <actuator><motor joint="s"/></actuator></mujoco>)";
  const auto device_of = [&](const std::string& value) {
    return parse_device(
        "[mechanism]\ntext = '''" + slide + "'''\ntip = \"tip\"\nnormal = [1, 0, 0]\n[loop]\nsampling_period = 1e-3\n",
        "slide.toml", std::vector<std::string>{"mechanism.joint.s.damping=" + value});
  };
  const auto linear = device_of("4 N s/m");
  ASSERT_TRUE(linear) << linear.error().str();
  EXPECT_EQ(motion_of_key(linear->parameters(), "mechanism.joint.s.damping"), Motion::linear);
  // b - K T/2 = 0 of the rigid body, nearly
  EXPECT_NEAR(critical_stiffness(*linear).stiffness, 8000.0, 10.0);
  const auto rotary = device_of("4 N m s/rad");
  ASSERT_FALSE(rotary);
  EXPECT_EQ(rotary.error().problem->code, ProblemCode::unit_of_other_joint);
  EXPECT_EQ(rotary.error().place.key, "mechanism.joint.s.damping");
}

TEST(MechanismNumbers, WhatIsNotThereIsRefusedWithWhatIs) {
  const auto subject = [](const InputError& error, std::string_view name) {
    for (const Subject& each : error.problem->subjects) {
      if (each.name == name) return each.text;
    }
    return std::string();
  };
  const InputError joint = refused(reference_arm, {"mechanism.joint.wrist.damping=1"});
  EXPECT_EQ(joint.problem->code, ProblemCode::no_such_part);
  EXPECT_EQ(joint.place.key, "mechanism.joint.wrist.damping");
  EXPECT_EQ(subject(joint, "names"), R"("shoulder", "elbow", "motor 1", "motor 2")");
  const InputError tendon = refused(reference_arm, {"mechanism.tendon.cable 3.stiffness=1"});
  EXPECT_EQ(subject(tendon, "names"), R"("cable 1", "cable 2")");
  EXPECT_EQ(subject(tendon, "kind"), "tendon");
  EXPECT_EQ(refused(reference_arm, {"mechanism.joint.elbow.dampng=1"}).problem->code, ProblemCode::unknown_key);
  EXPECT_EQ(refused(reference_arm, {"mechanism.tendon.cable 1.armature=1"}).problem->code, ProblemCode::unknown_key);
  for (const char* value : {"-1", "nan", "inf", "1e31", "text", "1 kg", "[1]"}) {
    SCOPED_TRACE(value);
    EXPECT_EQ(refused(reference_arm, {fmt::format("mechanism.joint.elbow.damping={}", value)}).place.key,
              "mechanism.joint.elbow.damping");
  }
  EXPECT_EQ(refused(reference_arm, {"mechanism.joint.elbow=3"}).problem->code, ProblemCode::of_other_type);
  EXPECT_EQ(refused(reference_arm, {"mechanism.joint=3"}).place.key, "mechanism.joint");
  EXPECT_EQ(refused(reference_arm, {}, "[mechanism.joint.knee]\ndamping = 1\n").place.line, 44U);
  DeviceParameters unknown = read(reference_arm).parameters();
  EXPECT_THROW(set_parameter(unknown, "mechanism.joint.wrist.damping", 1.0), Error);
  unknown.mechanism->mechanism.numbers["body.upper.mass"] = 1.0;
  EXPECT_EQ(find_problem(unknown).value().problem->code, ProblemCode::no_parameter_of_device);
}

TEST(MechanismNumbers, SlopesAreThoseOfTheLimits) {
  const Device device = read(reference_arm);
  const std::vector<Sensitivity> nobody = stiffness_sensitivities(device);
  const std::vector<Sensitivity> any_user = absolute_stability_sensitivities(device);
  const auto limit_at = [&](const std::string& key, double value, bool with_any_user) {
    DeviceParameters moved = device.parameters();
    set_parameter(moved, key, value);
    const Device there(std::move(moved));
    return with_any_user ? absolute_stability_limit(there, {}).stiffness : critical_stiffness(there).stiffness;
  };
  struct Slope {
    const char* key;
    double step;
    bool only_grows;
  };
  for (const auto& [key, step, only_grows] :
       {Slope{"mechanism.tendon.cable 1.stiffness", 0.4, false}, Slope{"mechanism.tendon.cable 2.damping", 1e-4, false},
        Slope{"mechanism.joint.motor 1.damping", 1e-6, false}, Slope{"mechanism.joint.motor 2.armature", 1e-8, true},
        Slope{"mechanism.joint.elbow.damping", 1e-5, false}}) {
    for (const bool with_any_user : {false, true}) {
      SCOPED_TRACE(fmt::format("{} {}", key, with_any_user));
      const std::vector<Sensitivity>& all = with_any_user ? any_user : nobody;
      const auto found = std::ranges::find(all, key, &Sensitivity::key);
      ASSERT_NE(found, all.end());
      const double value = found->value;
      const double here = limit_at(key, value, with_any_user);
      const double more = limit_at(key, value + step, with_any_user);
      const double slope =
          only_grows ? (4.0 * more - limit_at(key, value + 2.0 * step, with_any_user) - 3.0 * here) / (2.0 * step)
                     : (more - limit_at(key, value - step, with_any_user)) / (2.0 * step);
      EXPECT_NEAR(found->slope, slope, 2e-3 * std::abs(slope) + 1e-7 * here / step);
      EXPECT_EQ(found->relative.has_value(), !only_grows);
    }
  }
}

TEST(MechanismNumbers, AreSweptAndStudied) {
  const Device device = read(reference_arm);
  const ParameterSweep found = parameter_sweep(
      device, {{.key = "mechanism.tendon.cable 1.stiffness", .first = 251.3, .last = 400.0, .count = 2}}, {});
  ASSERT_EQ(found.points.size(), 2U);
  EXPECT_EQ(found.points[0].stiffness,
            critical_stiffness(read(edited(cable, R"(stiffness="251.3" damping="0.05")"))).stiffness);
  const auto study = parse_study(
      "[[parameter]]\nkey = \"mechanism.tendon.cable 1.stiffness\"\ndistribution = \"normal\"\nstandard_deviation = "
      "\"0.02 kN m/rad\"\n",
      "study.toml", device, std::nullopt);
  ASSERT_TRUE(study) << study.error().str();
  EXPECT_EQ(study->distributions.parameters[0].distribution.centre, 400.0);
}

// A joint that is damped through its cable alone still is: what users leave does not jump where the cable's damping goes to 0.
TEST(MechanismNumbers, WhatUsersLeaveGoesOnToACableWithoutDamping) {
  const auto any_user = [](const std::string& damping) {
    const Device device =
        read(reference_arm, {"mechanism.joint.elbow.damping=0", "mechanism.tendon.cable 2.damping=" + damping});
    const Analysis analysis = analyze(device);
    EXPECT_LT(analysis.any_user.value().stiffness, 0.95 * analysis.critical.stiffness);
    return analysis.any_user.value().stiffness;
  };
  EXPECT_NEAR(any_user("0") / any_user("1e-9"), 1.0, 1e-4);
}

}  // namespace
}  // namespace zwidth
