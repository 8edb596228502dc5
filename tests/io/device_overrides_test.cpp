#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/device_texts.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

DeviceParameters read_with(const std::string& text, const std::vector<std::string>& overrides) {
  const auto device = parse_device(text, "test.toml", overrides);
  if (!device) throw std::runtime_error(device.error().str());
  return device->parameters();
}

TEST(Overrides, ReachEveryKindOfKey) {
  const DeviceParameters device =
      read_with(full_device_text, {"name=other name", "loop.delay=0.5e-3", "loop.sensed=motor", "body.motor.mass=0.4",
                                   "body.1.damping = 2", "link.stiffness=1e5", "link.0.damping=7", "wall.stiffness=100",
                                   "operator.mass=1", "sensor.resolution=0", "actuator.force_limit=30"});
  EXPECT_EQ(device.name, "other name");
  EXPECT_EQ(device.loop.delay, 0.5e-3);
  EXPECT_EQ(device.loop.sensed, 0U);
  EXPECT_EQ(device.bodies[0].mass, 0.4);
  EXPECT_EQ(device.bodies[1].damping, 2.0);
  EXPECT_EQ(device.links[0].stiffness, 1e5);
  EXPECT_EQ(device.links[0].damping, 7.0);
  EXPECT_EQ(device.wall.stiffness, 100.0);
  EXPECT_EQ(device.user.mass, 1.0);
  EXPECT_EQ(device.sensor.resolution, 0.0);
  EXPECT_EQ(device.actuator.force_limit, 30.0);
}

TEST(Overrides, GiveKeysThatTheFileLeftOut) {
  const DeviceParameters device =
      read_with(small_device_text, {"wall.stiffness=100", "loop.delay=1e-3", "body.damping=3", "motion=rotary"});
  EXPECT_EQ(device.wall.stiffness, 100.0);
  EXPECT_EQ(device.loop.delay, 1e-3);
  EXPECT_EQ(device.bodies[0].damping, 3.0);
  EXPECT_EQ(device.motion, Motion::rotary);
}

TEST(Overrides, ApplyInOrder) {
  EXPECT_EQ(read_with(small_device_text, {"loop.delay=1e-3", "loop.delay=2e-3"}).loop.delay, 2e-3);
  const auto renamed = read_with(small_device_text, {"body.handle.name=knob", "body.knob.mass=5"});
  EXPECT_EQ(renamed.bodies[0].name, "knob");
  EXPECT_EQ(renamed.bodies[0].mass, 5.0);
}

TEST(Overrides, ReplaceMassAndInertiaByEachOther) {
  const std::string text = "motion = \"rotary\"\n[[body]]\nname = \"a\"\ninertia = 2\n[loop]\nsampling_period = 1e-3\n";
  EXPECT_EQ(read_with(text, {"body.a.mass=3"}).bodies[0].mass, 3.0);
  EXPECT_EQ(read_with(text, {"body.a.mass=3", "body.a.inertia=4"}).bodies[0].mass, 4.0);
}

TEST(Overrides, FindBodiesWhoseNamesHaveDotsOrDigits) {
  const std::string text =
      "body = [{name = \"a.b\", mass = 1}, {name = \"0\", mass = 2}]\n"
      "link = [{between = [\"a.b\", \"0\"], stiffness = 1}]\nloop.sampling_period = 1e-3\n";
  EXPECT_EQ(read_with(text, {"body.a.b.mass=3"}).bodies[0].mass, 3.0);
  EXPECT_EQ(read_with(text, {"body.0.mass=3"}).bodies[1].mass, 3.0);  // the name, before the index
  EXPECT_EQ(read_with(text, {"body.1.mass=3"}).bodies[1].mass, 3.0);
}

TEST(Overrides, SetATransferFunction) {
  const auto device = read_with("loop.sampling_period = 1e-3\n",
                                {"transfer_function.numerator=[1]", "transfer_function.denominator=[1, 2]"});
  ASSERT_TRUE(device.transfer_function.has_value());
  EXPECT_EQ(device.transfer_function->denominator, (std::vector<double>{1.0, 2.0}));
}

struct BadOverride {
  std::string name;
  std::string assignment;
  std::string message;
};

class RefusedOverride : public testing::TestWithParam<BadOverride> {};

TEST_P(RefusedOverride, IsNamed) {
  const std::vector<std::string> overrides{GetParam().assignment};
  const auto device = parse_device(two_body_text, "f.toml", overrides);
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().str(), GetParam().message);
}

const std::string must_be_value =
    "must be a TOML value such as 0.25e-3, \"handle\" or [1, 2], or a number with its unit";

const BadOverride overrides[] = {
    {"no_equals", "loop.delay", "an override: \"loop.delay\" is not KEY=VALUE; write for instance loop.delay=0.25e-3"},
    {"no_key", "=3", "an override: \"=3\" is not KEY=VALUE; write for instance loop.delay=0.25e-3"},
    {"no_value", "loop.delay=", "an override: loop.delay: cannot read the value \"\"; " + must_be_value},
    {"two_values", "loop.delay=1 2", "an override: loop.delay: cannot read the value \"1 2\"; " + must_be_value},
    {"two_lines", "loop.delay=1\nname=\"x\"",
     "an override: loop.delay: cannot read the value \"1\\x0Aname=\"x\"\"; " + must_be_value},
    {"zero_byte", std::string("name=a\0b", 8),
     std::string("an override: name: cannot read the value \"a\\x00b\"; ") + must_be_value},
    {"half_number", "loop.delay=.5", "an override: loop.delay: cannot read the value \".5\"; " + must_be_value},
    {"unknown_table", "lop.delay=1", "an override: lop.delay: unknown key \"lop\"; did you mean \"loop\"?"},
    {"unknown_key", "loop.dely=1", "an override: loop.dely: unknown key \"dely\"; did you mean \"delay\"?"},
    {"unknown_body_key", "body.motor.mas=1",
     "an override: body.motor.mas: unknown key \"mas\"; did you mean \"mass\"?"},
    {"key_without_table", "delay=1", "an override: delay: unknown key \"delay\"; it belongs in [loop]"},
    {"key_of_a_value", "motion.x=1", "an override: motion.x: \"motion\" is one value, not a table; write motion=VALUE"},
    {"misspelt_body", "body.hanle.mass=1",
     "an override: body.hanle.mass: there is no body \"hanle\"; did you mean \"handle\"?"},
    {"no_such_body", "body.5.mass=1", "an override: body.5.mass: there is no body \"5\"; the bodies are motor, handle"},
    {"which_body", "body.mass=1",
     "an override: body.mass: could be in any of 2 [[body]]; write for instance body.0.mass"},
    {"no_such_link", "link.1.damping=1",
     "an override: link.1.damping: there is no link \"1\"; must be link.0 to link.0"},
    {"text_for_number", "body.handle.mass=abc",
     "an override: body.handle.mass: is the text \"abc\"; must be a number of kg, or a text with its unit such as "
     "\"220 g\""},
    {"unit_of_another_kind", "loop.delay=2 mm",
     "an override: loop.delay: \"mm\" is no unit of a time; must be a number of s, or a text with its unit such as "
     "\"1.5 ms\""},
    {"quoted_unit_of_another_kind", "loop.delay=\"2 mm\"",
     "an override: loop.delay: \"mm\" is no unit of a time; must be a number of s, or a text with its unit such as "
     "\"1.5 ms\""},
    {"impossible_value", "body.motor.mass=-3", "an override: body.motor.mass: is -3; must be a finite number > 0"},
    {"impossible_link", "link.stiffness=-1", "an override: link.0.stiffness: is -1; must be a finite number >= 0"},
    {"value_for_table", "wall=3", "an override: wall: is the number 3; must be a table, [wall]"},
    {"body_of_loop", "loop.sensed=handel",
     "an override: loop.sensed: there is no body \"handel\"; did you mean \"handle\"?"},
    {"linear_inertia", "operator.inertia=1",
     "an override: operator.inertia: is for rotary motion; must be \"mass\", or set motion = \"rotary\""},
};

INSTANTIATE_TEST_SUITE_P(Overrides, RefusedOverride, testing::ValuesIn(overrides),
                         [](const auto& test) { return test.param.name; });

TEST(Overrides, TakeUnits) {
  const auto delay = [](const std::string& value) {
    const std::vector<std::string> assignment{"loop.delay=" + value};
    const auto device = parse_device(small_device_text, "f.toml", assignment);
    return device ? device->loop().delay : -1.0;
  };
  EXPECT_EQ(delay("0.25e-3"), 0.25e-3);
  EXPECT_EQ(delay("0.25 ms"), 0.25e-3);
  EXPECT_EQ(delay("0.25ms"), 0.25e-3);
  EXPECT_EQ(delay("250 us"), 0.25e-3);
  EXPECT_EQ(delay("\"250 us\""), 0.25e-3);
  EXPECT_EQ(delay(" 250 \u00b5s "), 0.25e-3);
}

TEST(Overrides, AddNoBodyOrLink) {
  const std::vector<std::string> assignment{"link.stiffness=3"};
  const auto device = parse_device(small_device_text, "f.toml", assignment);
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(
      device.error().str(),
      "an override: link.stiffness: the device has no [[link]]; an override changes what the file has; it adds no body "
      "or link");
}

TEST(Overrides, LeaveErrorsOfTheFileToTheFile) {
  const std::vector<std::string> assignment{"wall.stiffness=3", "body.motor.mass=3"};
  const auto device = parse_device("wall = 3\nbody = 4\n", "f.toml", assignment);
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().place.file, "f.toml");
}

}  // namespace
}  // namespace zwidth
