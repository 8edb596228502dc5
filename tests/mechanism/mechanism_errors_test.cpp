// Files that make no device end in an error with its code, whatever they say; no process ends.
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "zwidth/error.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

using enum ProblemCode;

// One hinge with its motor, and what a case adds.
std::string paddle(const std::string& in_body, const std::string& behind = "",
                   const std::string& motor = "<actuator><motor joint='a'/></actuator>") {
  return "<mujoco><compiler angle='radian'/><worldbody>\n<body name='b'>\n<joint name='a' axis='0 0 1'/>\n" + in_body +
         "\n</body></worldbody>" + behind + motor + "</mujoco>";
}

const std::string mass = "<inertial pos='0.1 0 0' mass='1' diaginertia='0.1 0.1 0.1'/>";
const std::string tip = "<site name='tip' pos='0.2 0 0'/>";

MechanismFile mechanism(const std::string& text) {
  MechanismFile file;
  file.text = text;
  file.tip = "tip";
  return file;
}

Device device(const MechanismFile& file) {
  DeviceParameters parameters;
  parameters.loop.sampling_period = 1e-3;
  return device_along(at_pose(file), {0.0, 1.0, 0.0}, parameters);
}

std::optional<ProblemCode> code_of(const MechanismFile& file) {
  try {
    (void)device(file);
  } catch (const Error& error) {
    if (error.problems().empty() || !error.problems().front().problem) return of_the_device;
    return error.problems().front().problem->code;
  }
  return std::nullopt;
}

// MuJoCo's own errors name lines of the text that it gets, which are the file's.
TEST(MechanismErrors, TheReadersLinesAreTheFiles) {
  try {
    (void)at_pose(mechanism(
        paddle("<geom type='mesh' mesh='m' mass='0'/>\n<!-- a\n b -->\n" + mass + "\n<joint axis='a'/>" + tip)));
    FAIL() << "it was read";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("line 8"), std::string::npos) << error.what();
  }
}

TEST(MechanismErrors, EachHasItsCode) {
  EXPECT_EQ(code_of(mechanism(paddle(mass + tip))), std::nullopt);
  EXPECT_EQ(code_of(mechanism(paddle(mass))), no_such_part);
  EXPECT_EQ(code_of(mechanism(paddle(mass + tip, "", ""))), no_motor);
  EXPECT_EQ(code_of(mechanism(paddle(tip))), mechanism_file_refused);  // without mass
  EXPECT_EQ(code_of(mechanism(paddle("<geom type='mesh' mesh='m'/>" + tip))), mass_of_mesh);
  EXPECT_EQ(code_of(mechanism("<mujoco><worldbody><site name='tip'/></worldbody></mujoco>")), mechanism_file_refused);
  EXPECT_EQ(code_of(mechanism("<html/>")), mechanism_file_refused);
  EXPECT_EQ(code_of(mechanism(paddle("<body><joint type='ball'/>" + mass + tip + "</body>" + mass))),
            joint_of_many_motions);
}

// A motor that floats: nothing ties it to the paddle.
TEST(MechanismErrors, AMotorThatFloatsMovesNoTip) {
  const std::string rotor = "</body><body><joint name='m' axis='0 0 1'/>" + mass;
  EXPECT_EQ(code_of(mechanism(paddle(mass + tip + rotor, "", "<actuator><motor joint='m'/></actuator>"))),
            tip_not_determined_by_encoders);
  const std::string cable =
      "<tendon><fixed stiffness='100'><joint joint='a' coef='1'/><joint joint='m' coef='-0.1'/></fixed></tendon>";
  EXPECT_EQ(code_of(mechanism(paddle(mass + tip + rotor, cable, "<actuator><motor joint='m'/></actuator>"))),
            std::nullopt);
}

TEST(MechanismErrors, ALoopThatCannotCloseIsRefused) {
  const auto five_bar = [](double reach) {
    const std::string joint = "<joint axis='0 0 1'";
    return "<mujoco><compiler angle='radian'/><worldbody><body><joint name='a' axis='0 0 1'/>" + mass +
           "<body pos='0.1 0 0'>" + joint + "/>" + mass + tip + "</body></body><body pos='" + std::to_string(reach) +
           " 0 0'><joint name='b' axis='0 0 1'/>" + mass + "<body name='end' pos='0.1 0 0'>" + joint + "/>" + mass +
           "<site name='e' pos='0.15 0 0'/></body></body></worldbody><equality><connect body1='end' body2='end' "
           "anchor='0 0 0' active='false'/></equality><actuator><motor joint='a'/><motor "
           "joint='b'/></actuator></mujoco>";
  };
  EXPECT_NE(code_of(mechanism(five_bar(0.05))), loop_does_not_close);  // nothing to close
  // A slider tied to the world a metre beyond its hinge's reach.
  const std::string far = "<equality><connect body1='b' anchor='0.2 0 0'/></equality>";
  MechanismFile turned = mechanism(paddle(mass + tip, far));
  EXPECT_EQ(code_of(turned), tip_does_not_move);  // closed, and so held
  turned.pose["a"] = 1.0;
  EXPECT_EQ(code_of(turned), loop_does_not_close);
}

TEST(MechanismErrors, AnUnitIsThatOfTheJoint) {
  MechanismFile file = mechanism(paddle(mass + tip));
  file.pose["a"] = 0.1;
  file.units_of_pose["a"] = Motion::rotary;
  EXPECT_EQ(code_of(file), std::nullopt);
  file.units_of_pose["a"] = Motion::linear;
  EXPECT_EQ(code_of(file), unit_of_other_joint);
}

TEST(MechanismErrors, NumbersThatAreNoneAreRefused) {
  for (const std::string value : {"nan", "inf", "1e400", "-1", "1e300"}) {
    SCOPED_TRACE(value);
    EXPECT_TRUE(code_of(mechanism(paddle("<inertial pos='0 0 0' mass='1' diaginertia='1 1 " + value + "'/>" + tip))));
    const std::string sprung = "<body><joint axis='0 0 1' stiffness='" + value + "'/>" + mass + tip + "</body>" + mass;
    EXPECT_TRUE(code_of(mechanism(paddle(sprung))));
  }
  for (const std::string value : {"nan", "inf", "1e400"}) {
    EXPECT_TRUE(code_of(mechanism(paddle(mass + "<site name='tip' pos='" + value + " 0 0'/>")))) << value;
  }
}

// Numbers that no joint, tendon or body has are named, with where they stand.
TEST(MechanismErrors, ANumberThatIsNoneIsNamed) {
  const auto of_joint = [](const std::string& attribute, const std::string& value) {
    std::string text = paddle(mass + tip);
    const std::string joint = "<joint name='a' axis='0 0 1'";
    return mechanism(text.replace(text.find(joint), joint.size(), joint + " " + attribute + "='" + value + "'"));
  };
  for (const std::string attribute : {"damping", "stiffness", "frictionloss"}) {
    for (const std::string value : {"-1", "nan", "inf", "1e300"}) {
      SCOPED_TRACE(attribute + " " + value);
      try {
        (void)at_pose(of_joint(attribute, value));
        ADD_FAILURE() << "it was read";
      } catch (const Error& error) {
        ASSERT_EQ(error.problems().size(), 1U);
        const Problem& problem = *error.problems().front().problem;
        EXPECT_EQ(problem.code, mechanism_file_refused);
        EXPECT_EQ(problem.subjects, (std::vector<Subject>{{"part", "joint's"}, {"of", "a"}, {"attribute", attribute}}));
      }
    }
  }
  for (const std::string value : {"-10", "nan", "1e300"}) {
    EXPECT_EQ(code_of(of_joint("armature", value)), mechanism_file_refused) << value;
  }
  MechanismFile turned_far = of_joint("ref", "1e300");
  EXPECT_EQ(code_of(turned_far), mechanism_file_refused);
  turned_far.pose["a"] = 0.1;
  EXPECT_EQ(code_of(turned_far), mechanism_file_refused);
  EXPECT_EQ(code_of(mechanism(paddle(mass + tip, "", "<actuator><motor joint='a' gear='nan'/></actuator>"))),
            mechanism_file_refused);
  MechanismFile far = mechanism(paddle(mass + tip));
  far.pose["a"] = 1e18;
  EXPECT_EQ(code_of(far), mechanism_file_refused);
}

TEST(MechanismErrors, WhatIsWrongInATextStandsAtTheText) {
  const auto key_of = [](const MechanismFile& file) {
    try {
      (void)at_pose(file);
    } catch (const Error& error) {
      return error.problems().empty() ? "" : error.problems().front().place.key;
    }
    return std::string("nothing");
  };
  const std::string no_mass = paddle(tip);
  EXPECT_EQ(key_of(mechanism(no_mass)), "mechanism.text");
  const std::string path = testing::TempDir() + "no_mass.xml";
  std::ofstream(path) << no_mass;
  MechanismFile file;
  file.path = path;
  EXPECT_EQ(key_of(file), "mechanism.file");
}

// A motor that pulls at the tip drives no joint, and so no encoder is known.
TEST(MechanismErrors, AMotorAtASiteNeedsItsEncoders) {
  MechanismFile file = mechanism(paddle(mass + tip, "", "<actuator><motor site='tip' gear='0 1 0 0 0 0'/></actuator>"));
  EXPECT_EQ(code_of(file), tip_not_determined_by_encoders);
  file.encoders = {"a"};
  EXPECT_EQ(code_of(file), std::nullopt);
}

// A tendon between points of the world neither moves nor rubs.
TEST(MechanismErrors, ATendonThatNothingMovesIsNone) {
  const std::string still =
      "<tendon><spatial stiffness='10' damping='1' frictionloss='1'><site site='e'/><site site='f'/>"
      "</spatial></tendon>";
  const std::string ends = "</body><site name='e'/><site name='f' pos='1 0 0'/><body>";
  EXPECT_EQ(code_of(mechanism(paddle(mass + tip + ends, still))), std::nullopt);
}

// The cable goes from the paddle to the world, and the motor stands beside it.
TEST(MechanismErrors, AMotorBesideTheCableMovesNoTip) {
  const std::string rotor = "</body><body><joint name='m' axis='0 0 1'/>" + mass;
  const std::string cable =
      "<tendon><fixed stiffness='100'><joint joint='a' coef='1'/><joint joint='m' coef='0'/></fixed></tendon>";
  EXPECT_EQ(code_of(mechanism(paddle(mass + tip + rotor, cable, "<actuator><motor joint='m'/></actuator>"))),
            tip_not_determined_by_encoders);
}

TEST(MechanismErrors, ATipBeyondReachIsRefused) {
  EXPECT_EQ(code_of(mechanism(paddle(mass + "<site name='tip' pos='1e7 0 0'/>"))), mechanism_file_refused);
}

TEST(MechanismErrors, DragInAFluidIsRefused) {
  std::string text = paddle(mass + tip);
  text.insert(text.find("<worldbody>"), "<option viscosity='0.1'/>");
  EXPECT_EQ(code_of(mechanism(text)), mechanism_file_refused);
}

// A cable of fixed length is a gear: its spring and its damping do nothing.
TEST(MechanismErrors, ACableOfFixedLengthIsAGear) {
  const auto limit = [](const std::string& equality) {
    const std::string rotor =
        "</body><body><joint name='m' axis='0 0 1' damping='1e-3'/><inertial pos='0 0 0' mass='0.1' "
        "diaginertia='1e-4 1e-4 1e-4'/>";
    const std::string cable =
        "<tendon><fixed name='cable' stiffness='400' damping='0.05' springlength='0'><joint joint='m' coef='0.1'/>"
        "<joint joint='a' coef='-1'/></fixed></tendon>";
    const std::string motor = "<equality>" + equality + "</equality><actuator><motor joint='m'/></actuator>";
    return critical_stiffness(device(mechanism(paddle(mass + tip + rotor, cable, motor)))).stiffness;
  };
  EXPECT_NEAR(limit("<tendon tendon1='cable'/>") / limit("<joint joint1='m' joint2='a' polycoef='0 10 0 0 0'/>"), 1.0,
              1e-9);
}

TEST(MechanismErrors, IncludesStayBesideTheFile) {
  const std::string path = testing::TempDir() + "including.xml";
  MechanismFile file;
  file.path = path;
  file.tip = "tip";
  std::ofstream(testing::TempDir() + "paddle.xml") << paddle(mass + tip);
  for (const std::string& name : {std::string("../paddle.xml"), std::string("a/../../paddle.xml"),
                                  testing::TempDir() + "paddle.xml", std::string("/dev/zero"), std::string(".")}) {
    std::ofstream(path) << "<mujoco><include file='" << name << "'/></mujoco>";
    EXPECT_EQ(code_of(file), include_not_read) << name;
  }
  std::ofstream(path) << "<mujoco><include file='./paddle.xml'/></mujoco>";
  EXPECT_EQ(code_of(file), std::nullopt);
}

// Meshes that are not there, a size that would take all memory: what does not count is not read.
TEST(MechanismErrors, WhatDoesNotCountChangesNothing) {
  const double plain = critical_stiffness(device(mechanism(paddle(mass + tip)))).stiffness;
  const std::string path = testing::TempDir() + "with_meshes.xml";
  std::ofstream(path) << paddle(
      mass + tip + "<geom type='mesh' mesh='m' material='s'/>",
      "<size nstack='1000000000000' njmax='2000000000'/><asset><mesh name='m' file='none.stl'/>"
      "<material name='s'/></asset>");
  MechanismFile file;
  file.path = path;
  file.tip = "tip";
  EXPECT_EQ(critical_stiffness(device(file)).stiffness, plain);
}

TEST(MechanismErrors, UrdfHasItsInertiasAndItsLinks) {
  const std::string urdf =
      "<robot name='r'><link name='base'/><link name='paddle'><inertial><origin xyz='0.1 0 0'/><mass value='1'/>"
      "<inertia ixx='0.1' iyy='0.1' izz='0.1' ixy='0' ixz='0' iyz='0'/></inertial></link><link name='tip'/>"
      "<joint name='a' type='continuous'><parent link='base'/><child link='paddle'/><axis xyz='0 0 1'/></joint>"
      "<joint name='f' type='fixed'><parent link='paddle'/><child link='tip'/><origin xyz='0.2 0 0'/></joint></robot>";
  MechanismFile file = mechanism(urdf);
  EXPECT_EQ(code_of(file), no_motor);
  file.transmissions.push_back({.joint = "a", .inertia = 1e-4});
  const double expected = at_pose(mechanism(paddle(mass + tip))).mass(0, 0) + 1e-4;
  EXPECT_NEAR(at_pose(file).mass(0, 0), expected, 1e-15);
  EXPECT_EQ(code_of(file), std::nullopt);
}

// MuJoCo 2.2.2 ends its process with such a type of joint.
TEST(MechanismErrors, WhatCrashesTheReaderIsRefused) {
  const std::string urdf =
      "<robot name='r'><link name='base'/><link name='tip'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' "
      "ixy='0' ixz='0' iyz='0'/></inertial></link><joint name='a' type='{}'><parent link='base'/><child link='tip'/>"
      "</joint></robot>";
  const auto of_type = [&](const std::string& type) {
    std::string text = urdf;
    return code_of(mechanism(text.replace(text.find("{}"), 2, type)));
  };
  EXPECT_EQ(of_type("unheard"), mechanism_file_refused);
  EXPECT_EQ(of_type("continuous"), no_motor);
}

// Bytes of a good file changed at random: an error or a device, and the next file is read as ever.
TEST(MechanismErrors, DamagedFilesEndInErrors) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.xml");
  const std::string good(std::istreambuf_iterator<char>(file), {});
  std::mt19937 random(46);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string text = good;
    for (int change = 0; change < 3; ++change) {
      const std::size_t at = random() % text.size();
      if (random() % 2 == 0) text[at] = static_cast<char>(random() % 256);
      if (random() % 2 == 0) text.erase(at, random() % 20);
    }
    if (code_of(mechanism(text))) ++refused;
  }
  EXPECT_GT(refused, 100);
  EXPECT_EQ(code_of(mechanism(paddle(mass + tip))), std::nullopt);
}

}  // namespace
}  // namespace zwidth
