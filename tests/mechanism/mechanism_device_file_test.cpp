// [mechanism] and [[transmission]] of a device file.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "zwidth/design/region.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
namespace {

using enum ProblemCode;

const std::string source = ZWIDTH_SOURCE_DIR "/tests/reference/arm.toml";  // no such file; what it names is beside

const std::string arm_text = R"([mechanism]
file = "planar_arm.xml"
tip = "tip"
pose = { shoulder = 0.3, elbow = 1.2 }
normal = [1, 0, 0]
[loop]
sampling_period = "1 ms"
)";

Device arm(const std::vector<std::string>& overrides = {}) {
  const auto device = parse_device(arm_text, source, overrides);
  if (!device) throw std::runtime_error(device.error().str());
  return *device;
}

InputError refusal(const std::string& text, const std::vector<std::string>& overrides = {},
                   FilesBeside files = FilesBeside::read) {
  const auto device = parse_device(text, source, overrides, files);
  if (device) throw std::runtime_error("not refused");
  return device.error();
}

std::string contents(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string replaced(std::string text, const std::string& one, const std::string& other) {
  return text.replace(text.find(one), one.size(), other);
}

TEST(MechanismDeviceFile, IsTheDeviceAlongTheNormal) {
  const Device device = arm();
  EXPECT_NEAR(analyze(device).limits.nobody.critical_stiffness, 318.881897, 1e-6);  // docs/theory.md, "Several axes"
  EXPECT_EQ(device.parameters().motion, Motion::linear);
  EXPECT_NEAR(analyze(arm({"mechanism.normal=[0,1,0]"})).limits.nobody.critical_stiffness, 1088.166236, 1e-6);
  const Device other = arm({"mechanism.pose.elbow=0.4"});
  EXPECT_NEAR(analyze(other).limits.nobody.critical_stiffness, 716.245862, 1e-6);
  const double degrees = 0.4 * 180.0 / std::numbers::pi;
  const Device in_degrees = arm({fmt::format("mechanism.pose.elbow={} deg", degrees)});
  EXPECT_NEAR(in_degrees.parameters().mechanism->mechanism.pose.at("elbow"), 0.4, 1e-15);
}

std::ptrdiff_t remarks_of(const Analysis& analysis, FindingCode code) {
  return std::ranges::count_if(analysis.remarks,
                               [code](const Remark& each) { return each.finding && each.finding->code == code; });
}

// docs/theory.md, "Several axes", to 1e-5: held along the normal alone the arm would allow more.
TEST(MechanismDeviceFile, AnyPassiveUserHoldsTheTipInEveryDirection) {
  const Analysis found = analyze(arm());
  ASSERT_TRUE(found.any_user);
  EXPECT_NEAR(found.any_user->stiffness / 278.8459, 1.0, 1e-5);
  EXPECT_NEAR(found.any_user->frequency / 84.3337, 1.0, 1e-3);
  EXPECT_FALSE(found.any_user->needs_no_user);
  EXPECT_EQ(found.limits.any_user.value().critical_stiffness, found.any_user->stiffness);
  EXPECT_EQ(remarks_of(found, FindingCode::any_grasp_scanned), 1);
  EXPECT_EQ(absolute_stability_limit(arm()).stiffness, found.any_user->stiffness);
  EXPECT_NEAR(analyze(arm({"mechanism.normal=[0,1,0]"})).any_user.value().stiffness / 999.6188, 1.0, 1e-5);
  const Analysis between = analyze(arm({"wall.stiffness=300"}));
  EXPECT_TRUE(between.wall_stable_for.value().nobody);
  EXPECT_EQ(between.wall_stable_for->any_user, false);
  EXPECT_EQ(remarks_of(between, FindingCode::stiffer_than_any_user_limit), 1);
  EXPECT_EQ(analyze(arm({"wall.stiffness=270"})).wall_stable_for.value().any_user, true);
}

// Property: the limit for any passive user is one of the device, whoever the file says holds it.
TEST(MechanismDeviceFile, AnyPassiveUserIsNotTheFiles) {
  const Analysis found = analyze(arm({"operator.mass=0.3", "operator.damping=5"}));
  EXPECT_NEAR(found.any_user.value().stiffness / 278.8459, 1.0, 1e-5);
}

// A normal with a part along which the tip cannot move: the wall knows and pushes that much less of the tip's motion.
TEST(MechanismDeviceFile, ANormalOutOfThePlaneIsSoftenedByItsShare) {
  const Analysis found = analyze(arm({"mechanism.normal=[3,0,4]"}));
  EXPECT_NEAR(found.limits.nobody.critical_stiffness / (318.881897 / 0.36), 1.0, 1e-8);
  EXPECT_NEAR(found.any_user.value().stiffness / (278.8459 / 0.36), 1.0, 1e-5);
}

// A lead of ratio 1 is no filter; a low-pass leaves less, and nobody holding no more.
TEST(MechanismDeviceFile, AnyPassiveUserBehindFilters) {
  const auto limit_behind = [](const std::string& filter) {
    const auto device = parse_device(arm_text + "[[wall.filter]]\n" + filter, source);
    EXPECT_TRUE(device) << device.error().str();
    const Analysis found = analyze(*device);
    EXPECT_EQ(remarks_of(found, FindingCode::any_grasp_scanned), 1);
    EXPECT_LE(found.any_user.value().stiffness, found.limits.nobody.critical_stiffness);
    return found.any_user.value().stiffness;
  };
  EXPECT_NEAR(limit_behind("type = \"lead_lag\"\nfrequency_hz = 100\nratio = 1\n") / 278.845911, 1.0, 1e-6);
  EXPECT_LT(limit_behind("type = \"low_pass\"\nfrequency_hz = 100\n"), 200.0);
}

// docs/theory.md, "Several axes": closed-loop eigenvalues.
TEST(MechanismDeviceFile, APointWallIsAnsweredByAnalyzeAndRegion) {
  const Device device = arm({"mechanism.normal=\"all\"", "wall.stiffness=200"});
  const Analysis found = analyze(device);
  EXPECT_EQ(found.critical.status, StiffnessStatus::finite);
  EXPECT_NEAR(found.critical.stiffness / 255.98844746532407, 1.0, 1e-8);
  EXPECT_EQ(found.limits.nobody.critical_stiffness, found.critical.stiffness);
  ASSERT_TRUE(found.point_wall);
  EXPECT_NEAR(found.point_wall->direction.norm(), 1.0, 1e-12);
  EXPECT_NEAR(found.point_wall->direction.z(), 0.0, 1e-12);
  ASSERT_TRUE(found.point_wall->any_user);
  EXPECT_LE(found.point_wall->any_user->at_least, found.point_wall->any_user->at_most);
  EXPECT_LE(found.point_wall->any_user->at_most, found.critical.stiffness);
  EXPECT_GT(found.point_wall->any_user->at_least, 0.0);
  EXPECT_FALSE(found.limits.any_user);
  EXPECT_FALSE(found.any_user);
  EXPECT_EQ(remarks_of(found, FindingCode::any_grasp_bounded), 1);
  ASSERT_TRUE(found.wall);
  EXPECT_TRUE(found.wall->stable);
  EXPECT_NEAR(found.wall->stiffness_margin.value() / (255.98844746532407 / 200.0), 1.0, 1e-8);
  EXPECT_FALSE(analyze(arm({"mechanism.normal=\"all\"", "wall.stiffness=257"})).wall_stable_for.value().nobody);
  const auto again = parse_device(write_device(device.parameters()), source);
  ASSERT_TRUE(again) << again.error().str();
  EXPECT_TRUE(is_point_wall(*again));
  EXPECT_EQ(write_device(again->parameters()), write_device(device.parameters()));
  EXPECT_THROW((void)critical_stiffness(device), Error);
  EXPECT_THROW((void)absolute_stability_limit(device), Error);
  const WallRegion walls = region(device);
  ASSERT_EQ(walls.status, WallRegion::Status::bounded);
  EXPECT_NEAR(walls.region.critical_stiffness / found.critical.stiffness, 1.0, 1e-8);
}

TEST(MechanismDeviceFile, ComesAsTextToo) {
  const std::string xml = contents(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.xml");
  const std::string text = replaced(arm_text, "file = \"planar_arm.xml\"", "text = '''\n" + xml + "'''");
  const auto device = parse_device(text, "device", {}, FilesBeside::refused);
  ASSERT_TRUE(device) << device.error().str();
  EXPECT_EQ(device->parameters().coordinates->mass, arm().parameters().coordinates->mass);
  const auto again = parse_device(write_device(device->parameters()), "device", {}, FilesBeside::refused);
  ASSERT_TRUE(again) << again.error().str();
  EXPECT_EQ(again->parameters().mechanism->mechanism.text, device->parameters().mechanism->mechanism.text);
  EXPECT_EQ(write_device(again->parameters()), write_device(device->parameters()));
}

TEST(MechanismDeviceFile, IsWrittenAsItIsRead) {
  const std::vector<std::string> overrides{"mechanism.encoders=[\"motor 1\", \"motor 2\"]", "operator.mass=0.1",
                                           "mechanism.pose.motor 1=0.1"};
  const Device device = arm(overrides);
  EXPECT_EQ(device.parameters().mechanism->mechanism.pose.at("motor 1"), 0.1);
  const auto again = parse_device(write_device(device.parameters()), "elsewhere/written.toml");
  ASSERT_TRUE(again) << again.error().str();
  EXPECT_EQ(write_device(again->parameters()), write_device(device.parameters()));
  EXPECT_EQ(again->parameters().coordinates->mass, device.parameters().coordinates->mass);
  EXPECT_EQ(again->parameters().user.mass, 0.1);
}

TEST(MechanismDeviceFile, HasMotorsBehindTransmissions) {
  const std::string xml = contents(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.xml");
  const std::string links = xml.substr(0, xml.find("    <body name=\"rotor 1\"")) + "</worldbody></mujoco>";
  std::string text = replaced(arm_text, "file = \"planar_arm.xml\"", "text = '''\n" + links + "'''");
  for (const auto& [joint, stiffness] : {std::pair{"shoulder", 400}, std::pair{"elbow", 300}}) {
    text += fmt::format(
        "[[transmission]]\njoint = \"{}\"\nratio = 10\ninertia = \"800 g cm^2\"\n"
        "motor_damping = 2e-4\nstiffness = \"{} N m/rad\"\ndamping = 0.05\n",
        joint, stiffness);
  }
  const auto device = parse_device(text, source);
  ASSERT_TRUE(device) << device.error().str();
  EXPECT_EQ(device->parameters().mechanism->mechanism.transmissions.at(0).inertia, 8e-5);
  EXPECT_NEAR(analyze(*device).limits.nobody.critical_stiffness, 318.881897, 1e-6);
  const auto again = parse_device(write_device(device->parameters()), source);
  ASSERT_TRUE(again) << again.error().str();
  EXPECT_EQ(write_device(again->parameters()), write_device(device->parameters()));
  const InputError refused = refusal(text, {"transmission.0.inertia=-1"});
  EXPECT_EQ(refused.place.key, "transmission.0.inertia");
  EXPECT_EQ(refusal(text, {"transmission.1.joint=wrist"}).place.key, "transmission.1.joint");
}

TEST(MechanismDeviceFile, RefusesWithPlaceAndCode) {
  struct Case {
    std::string one, other;
    ProblemCode code;
    std::string key;
    std::size_t line;
  };
  const std::vector<Case> cases{
      {"planar_arm.xml", "nowhere.xml", mechanism_file_refused, "mechanism.file", 2},
      {"tip = \"tip\"", "tip = \"finger\"", no_such_part, "mechanism.tip", 3},
      {"elbow = 1.2", "wrist = 1.2", no_such_part, "mechanism.pose.wrist", 4},
      {"elbow = 1.2", "elbow = \"1 mm\"", unit_of_other_joint, "mechanism.pose.elbow", 4},
      {"elbow = 1.2", "elbow = \"1 kg\"", unit_of_other_measure, "mechanism.pose.elbow", 4},
      {"elbow = 1.2", "elbow = nan", value_not_finite, "mechanism.pose.elbow", 4},
      {"[1, 0, 0]", "[1, 0]", normal_not_three_numbers, "mechanism.normal", 5},
      {"[1, 0, 0]", "[0, 0, 0]", no_direction, "mechanism.normal", 5},
      {"[1, 0, 0]", "[0, 0, 1]", tip_does_not_move, "mechanism.normal", 5},
      {"[loop]", "[loop]\nheld = \"tip\"", beside_mechanism, "loop.held", 7},
      {"[mechanism]", "motion = \"rotary\"\n[mechanism]", mechanism_of_rotary_motion, "motion", 1},
      {"tip = \"tip\"", "tips = \"tip\"", unknown_key, "mechanism.tips", 3},
      {"[loop]", "[[body]]\nname = \"a\"\nmass = 1\n[loop]", beside_mechanism, "body", 6},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.other);
    const InputError found = refusal(replaced(arm_text, each.one, each.other));
    EXPECT_EQ(found.problem->code, each.code) << found.str();
    EXPECT_EQ(found.place.key, each.key);
    EXPECT_EQ(found.place.line, each.line);
    EXPECT_EQ(found.place.file, source);
  }
  const InputError alone = refusal("[[body]]\nname = \"a\"\nmass = 1\n[loop]\nsampling_period = 1\n[[transmission]]\n");
  EXPECT_EQ(alone.problem->code, without_mechanism);
  EXPECT_EQ(alone.place.line, 6U);
}

TEST(MechanismDeviceFile, NamesNoFileWhereItCameAsText) {
  const InputError found = refusal(arm_text, {}, FilesBeside::refused);
  EXPECT_EQ(found.problem->code, file_beside_text);
  EXPECT_EQ(found.place.key, "mechanism.file");
  const InputError overridden = refusal(arm_text, {"mechanism.file=\"/etc/passwd\""}, FilesBeside::refused);
  EXPECT_EQ(overridden.problem->code, file_beside_text);
}

// As it is written where TOML can hold it so, and the same to the last byte in any case.
TEST(MechanismDeviceFile, ItsTextIsWrittenAsItWasRead) {
  DeviceParameters parameters = arm().parameters();
  MechanismFile& mechanism = parameters.mechanism->mechanism;
  const std::string as_read = contents(mechanism.path);
  mechanism.path.clear();
  for (const auto& [more, is_plain] :
       {std::pair{"", true}, {"<!-- it's \\ \" -->\n", true}, {"<!-- ''' -->", false}, {"<!-- -->\r\n", false}}) {
    mechanism.text = as_read + more;
    const std::string written = write_device(parameters);
    EXPECT_EQ(written.find("\n<mujoco") != std::string::npos, is_plain);
    const auto read = parse_device(written, "text", {}, FilesBeside::refused);
    ASSERT_TRUE(read.has_value()) << read.error().what;
    EXPECT_EQ(read->parameters().mechanism->mechanism.text, mechanism.text);
  }
}

// A file's text in place of its path is the same device.
TEST(MechanismDeviceFile, AFileAsTextIsTheSameDevice) {
  for (const char* name : {"planar_arm", "pantograph", "phantom_premium"}) {
    SCOPED_TRACE(name);
    const auto of_file = read_device_file(fmt::format("{}/devices/mechanisms/{}.toml", ZWIDTH_SOURCE_DIR, name));
    ASSERT_TRUE(of_file.has_value());
    DeviceParameters parameters = of_file->parameters();
    MechanismFile& mechanism = parameters.mechanism->mechanism;
    mechanism.text = MechanismModel(mechanism).text();
    mechanism.path.clear();
    const auto of_text = parse_device(write_device(parameters), "text", {}, FilesBeside::refused);
    ASSERT_TRUE(of_text.has_value()) << of_text.error().what;
    EXPECT_EQ(analyze(*of_text).limits.nobody.critical_stiffness, analyze(*of_file).limits.nobody.critical_stiffness);
    EXPECT_EQ(MechanismModel(of_text->parameters().mechanism->mechanism).text(), mechanism.text);
  }
}

// The elbow is damped by its motor behind the cable alone, which far aliases hardly see: what is not known there leaves no wall.
TEST(MechanismDeviceFile, ACableWithoutDampingLeavesLessThanNobodysLimit) {
  std::string mechanism = contents(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.xml");
  mechanism = replaced(std::move(mechanism), R"("elbow" axis="0 0 1" damping="2e-3")", R"("elbow" axis="0 0 1")");
  mechanism = replaced(std::move(mechanism), R"(stiffness="300" damping="0.05")", R"(stiffness="300")");
  const auto device =
      parse_device(replaced(arm_text, "file = \"planar_arm.xml\"", "text = '''\n" + mechanism + "'''"), source);
  ASSERT_TRUE(device) << device.error().str();
  const Analysis analysis = analyze(*device);
  EXPECT_LT(analysis.any_user.value().stiffness, 0.95 * analysis.critical.stiffness);
}

}  // namespace
}  // namespace zwidth
