// The sentences of what is wrong with a device file, an override or a study file, as they are read.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/device_texts.hpp"
#include "lhifam.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/io/device_variants.hpp"
#include "zwidth/io/study_file.hpp"

namespace zwidth {
namespace {

std::string told_of_device(const std::string& text, const std::vector<std::string>& overrides = {}) {
  const auto device = parse_device(text, "f.toml", overrides);
  return device ? "is read" : device.error().str();
}

std::string told_of_body(const std::string& key) { return told_of_device(body_text(key) + loop_text()); }

TEST(DeviceFileProblemText, SaysWhatStandsThereAndWhatMust) {
  EXPECT_EQ(told_of_body("damping = \"x\""),
            "f.toml:4:11: body.a.damping: is the text \"x\"; must be a number of N s/m, or a text with its unit such "
            "as \"5 N s/m\"");
  EXPECT_EQ(told_of_device("name = 1.5\n" + body_text("") + loop_text()),
            "f.toml:1:8: name: is the number 1.5; must be text in quotes");
  EXPECT_EQ(told_of_device("loop = 2020-02-02\n" + body_text("")),
            "f.toml:1:8: loop: is a date or time; must be a table, [loop]");
  EXPECT_EQ(told_of_device("body = true\n" + loop_text()), "f.toml:1:8: body: is true; must be tables, [[body]]");
  EXPECT_EQ(told_of_device(two_body_text + "[uncertainty]\nparameters = [\"link.stiffness\"]\ncovariance = [1]\n"),
            "f.toml:14:15: uncertainty.covariance: is the number 1; every row must be an array of numbers");
  EXPECT_EQ(told_of_device(two_body_text + "[uncertainty]\nparameters = [3]\ncovariance = [[1]]\n"),
            "f.toml:13:15: uncertainty.parameters: is the number 3; every element must be text in quotes");
}

TEST(DeviceFileProblemText, SaysWhatIsMissing) {
  EXPECT_EQ(told_of_device("[[body]]\nname = \"a\"\n" + loop_text()),
            "f.toml:1:1: body.a.mass: is missing; must be given as a number > 0");
  EXPECT_EQ(told_of_device(body_text("")),
            "f.toml:1:1: loop: is missing; must be given as [loop] with sampling_period in seconds");
  EXPECT_EQ(told_of_device(two_body_text + "[[link]]\nbetween = [\"motor\", \"handle\"]\n"),
            "f.toml:12:1: link.1.stiffness: is missing; must be given, or damping, or both");
  EXPECT_EQ(told_of_device(two_body_text + "[uncertainty]\ncovariance = [[1]]\n"),
            "f.toml:12:1: uncertainty.parameters: is missing; must be given as an array of keys such as "
            "\"link.0.stiffness\"");
}

TEST(DeviceFileProblemText, SaysWhichKeyIsMeant) {
  EXPECT_EQ(told_of_body("dampin = 1"), "f.toml:4:1: body.a.dampin: unknown key \"dampin\"; did you mean \"damping\"?");
  EXPECT_EQ(told_of_body("delay = 1"),
            "f.toml:4:1: body.a.delay: unknown key \"delay\"; it belongs in [loop] or [loop.damper]");
  EXPECT_EQ(
      told_of_device(body_text("") + loop_text() + "[sensor]\ncolour = 3\n"),
      "f.toml:9:1: sensor.colour: unknown key \"colour\"; the keys of [sensor] are resolution, tracking_bandwidth");
  EXPECT_EQ(told_of_body("J = 1"),
            "f.toml:4:1: body.a.J: unknown key \"J\"; did you mean \"mass\", or of rotary motion \"inertia\"?");
  EXPECT_EQ(told_of_body("k = 1"),
            "f.toml:4:1: body.a.k: unknown key \"k\"; did you mean \"stiffness\", in N/m or of rotary motion N m/rad?");
  EXPECT_EQ(told_of_device(body_text("") + "[loop]\nsampling_frequency = 2000\n"),
            "f.toml:6:1: loop.sampling_frequency: unknown key \"sampling_frequency\"; write sampling_period of [loop] "
            "in s, which is 1/frequency: \"500 us\" of 2 kHz");
  EXPECT_EQ(told_of_body("zeta = 0.1"),
            "f.toml:4:1: body.a.zeta: unknown key \"zeta\"; write damping in N s/m (N m s/rad), which is 2 "
            "damping_ratio sqrt(stiffness mass)");
  EXPECT_EQ(
      told_of_device(body_text("") + loop_text() + "[sensor]\ncpr = 4096\n"),
      "f.toml:9:1: sensor.cpr: unknown key \"cpr\"; write resolution, which is 1 turn/counts: \"1 turn/4096\" (of "
      "N lines with quadrature: 4 N counts)");
  EXPECT_EQ(told_of_body("friction = 1"),
            "f.toml:4:1: body.a.friction: unknown key \"friction\"; write damping for viscous friction (N s/m), "
            "coulomb for dry friction (N)");
}

TEST(DeviceFileProblemText, SaysWhatIsWrongWithAUnit) {
  const std::string a_damping = "must be a number of N s/m, or a text with its unit such as \"5 N s/m\"";
  EXPECT_EQ(told_of_body("damping = \"5\""), "f.toml:4:11: body.a.damping: \"5\" has no unit; " + a_damping);
  EXPECT_EQ(told_of_body("damping = \"5 N/m\""),
            "f.toml:4:11: body.a.damping: \"N/m\" is no unit of a damping; " + a_damping);
  EXPECT_EQ(told_of_body("damping = \"5 N s/mile\""),
            "f.toml:4:11: body.a.damping: cannot read the unit \"N s/mile\"; " + a_damping);
  EXPECT_EQ(told_of_body("damping = \"5 Ns/m\""),
            "f.toml:4:11: body.a.damping: cannot read the unit \"Ns/m\"; did you mean \"5 N s/m\"?");
  EXPECT_EQ(told_of_device(body_text("") + "[loop]\nsampling_period = \"2.5 kHz\"\n"),
            "f.toml:6:19: loop.sampling_period: \"kHz\" is no unit of a time; a period is 1/frequency: \"0.4 ms\"");
  EXPECT_EQ(told_of_device(body_text("") + loop_text() + "[sensor]\nresolution = \"200 counts/mm\"\n"),
            "f.toml:9:14: sensor.resolution: \"counts/mm\" is no unit of a length; a step is its inverse: \"1 "
            "mm/200\"");
  EXPECT_EQ(told_of_device("motion = \"rotary\"\n" + body_text("") + loop_text() + "[sensor]\nresolution = \"2 mm\"\n"),
            "f.toml:10:14: sensor.resolution: \"mm\" is no unit of an angle; must be a number of rad, or a text with "
            "its unit such as \"1 turn/4096\"");
  EXPECT_EQ(told_of_body("damping = 1,000"),
            "f.toml:4:11: body.a.damping: \"1,000\" has a comma; the decimal mark is a point, and nothing stands "
            "between thousands");
  EXPECT_EQ(told_of_body("damping = \"0,5 N s/m\""),
            "f.toml:4:11: body.a.damping: \"0,5 N s/m\" has a comma; the decimal mark is a point: 0.5 N s/m");
  EXPECT_EQ(told_of_body("damping = 5 N s/m"),
            "f.toml:4:11: body.a.damping: the text 5 N s/m has no quotes; write \"5 N s/m\"");
  EXPECT_EQ(told_of_body("damping = 1e400"),
            "f.toml:4:16: the number is out of range; must be 0 or from 1e-30 to 1e30 in magnitude (coefficients: "
            "1e-100 to 1e100)");
}

TEST(DeviceFileProblemText, SaysWhatIsWrongWithAnOverride) {
  const auto told = [](const std::string& assignment) { return told_of_device(two_body_text, {assignment}); };
  EXPECT_EQ(told("loop.delay"), "an override: \"loop.delay\" is not KEY=VALUE; write for instance loop.delay=0.25e-3");
  EXPECT_EQ(told("loop.delay=1 2"),
            "an override: loop.delay: cannot read the value \"1 2\"; must be a TOML value such as 0.25e-3, \"handle\" "
            "or [1, 2], or a number with its unit");
  EXPECT_EQ(told(std::string("name=a\0b", 8)),
            "an override: name: cannot read the value \"a\\x00b\"; must be a TOML value such as 0.25e-3, \"handle\" or "
            "[1, 2], or a number with its unit");
  EXPECT_EQ(told("motion.x=1"), "an override: motion.x: \"motion\" is one value, not a table; write motion=VALUE");
  EXPECT_EQ(told("body.mass=1"),
            "an override: body.mass: could be in any of 2 [[body]]; write for instance body.0.mass");
  EXPECT_EQ(told("body.hanle.mass=1"),
            "an override: body.hanle.mass: there is no body \"hanle\"; did you mean \"handle\"?");
  EXPECT_EQ(told("body.5.mass=1"), "an override: body.5.mass: there is no body \"5\"; the bodies are motor, handle");
  EXPECT_EQ(told("link.1.damping=1"), "an override: link.1.damping: there is no link \"1\"; must be link.0 to link.0");
  EXPECT_EQ(told("wall.filter.depth=1"),
            "an override: wall.filter.depth: the device has no [[wall.filter]]; to add one write "
            "wall.filter=[{type=\"low_pass\", frequency_hz=60}]");
  const auto variants = [](const std::string& assignment) {
    const auto all = device_variants(Device(test::lhifam_parameters()), assignment);
    return all ? "is read" : all.error().front().str();
  };
  EXPECT_EQ(variants("sensed"), "an override: is not KEY=VALUE,VALUE; write for instance sensed=motor,handle");
  EXPECT_EQ(variants("sensed=motor"), "an override: loop.sensed: has one value; give two or more");
  EXPECT_EQ(variants("sensed=motor,motor"), "an override: loop.sensed: \"motor\" is given twice; must be given once");
}

TEST(DeviceFileProblemText, SaysWhatIsNoDeviceFile) {
  EXPECT_EQ(told_of_device("{\"a\": 1}"),
            "f.toml:1:1: begins with a brace, as no TOML text does; must be the TOML text of a device");
  EXPECT_EQ(told_of_device("x = [[[[[[[[[[1]]]]]]]]]]"),
            "f.toml:1:13: is not TOML: Error while parsing value: exceeded maximum nested value depth of 8; must be "
            "the TOML text of a device");
  const auto none = read_device_file("none.toml");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().str(),
            "none.toml: cannot be read: No such file or directory; must be a readable device file, or \"-\" for "
            "standard input");
  const auto device = read_device_file("/dev/zero");
  ASSERT_FALSE(device);
  EXPECT_EQ(device.error().str(),
            "/dev/zero: is neither a file nor a pipe; must be a device file, or \"-\" for standard input");
}

TEST(DeviceFileProblemText, SaysWhatIsWrongWithAStudy) {
  const auto told = [](const std::string& lines) {
    const auto study = parse_study("[[parameter]]\nkey = \"link.stiffness\"\n" + lines, "s.toml",
                                   Device(test::lhifam_parameters()), std::nullopt);
    return study ? "is read" : study.error().str();
  };
  EXPECT_EQ(told("distribution = \"gauss\"\n"),
            "s.toml:3:16: parameter.0.distribution: is \"gauss\"; must be one of device, discrete, file, lognormal, "
            "normal, triangular, uniform");
  EXPECT_EQ(told("distribution = \"device\"\n"),
            "s.toml:3:16: parameter.0.distribution: the device's [uncertainty] does not tell link.stiffness; must be "
            "another distribution, or a device that identify wrote");
  EXPECT_EQ(told("distribution = \"uniform\"\nrelative_tolerance = 0\n"),
            "s.toml:4:22: parameter.0.relative_tolerance: is 0, of 79500; must be finite and > 0, of a number that is "
            "not 0");
  EXPECT_EQ(told("distribution = \"file\"\nfile = \"a.txt\"\n"),
            "s.toml:4:8: parameter.0.file: names a file, and there is none beside this study; must be \"discrete\" "
            "with the values and weights themselves");
}

}  // namespace
}  // namespace zwidth
