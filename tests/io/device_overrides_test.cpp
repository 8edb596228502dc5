#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/device_texts.hpp"
#include "io/problem_data.hpp"
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
  test::RefusedProblem refused;
};

class RefusedOverride : public testing::TestWithParam<BadOverride> {};

TEST_P(RefusedOverride, IsNamed) {
  const std::vector<std::string> overrides{GetParam().assignment};
  const auto device = parse_device(two_body_text, "f.toml", overrides);
  ASSERT_FALSE(device.has_value());
  test::expect_refused(device.error(), GetParam().refused);
}

const BadOverride overrides[] = {
    {"no_equals",
     "loop.delay",
     {test::of_override(""),
      {.code = ProblemCode::not_an_assignment, .subjects = {{"text", "loop.delay"}, {"form", "KEY=VALUE"}}}}},
    {"no_key",
     "=3",
     {test::of_override(""),
      {.code = ProblemCode::not_an_assignment, .subjects = {{"text", "=3"}, {"form", "KEY=VALUE"}}}}},
    {"no_value",
     "loop.delay=",
     {test::of_override("loop.delay"), {.code = ProblemCode::not_a_toml_value, .subjects = {{"text", ""}}}}},
    {"two_values",
     "loop.delay=1 2",
     {test::of_override("loop.delay"), {.code = ProblemCode::not_a_toml_value, .subjects = {{"text", "1 2"}}}}},
    {"two_lines",
     "loop.delay=1\nname=\"x\"",
     {test::of_override("loop.delay"),
      {.code = ProblemCode::not_a_toml_value, .subjects = {{"text", "1\nname=\"x\""}}}}},
    {"zero_byte",
     std::string("name=a\0b", 8),
     {test::of_override("name"),
      {.code = ProblemCode::not_a_toml_value, .subjects = {{"text", std::string("a\0b", 3)}}}}},
    {"half_number",
     "loop.delay=.5",
     {test::of_override("loop.delay"), {.code = ProblemCode::not_a_toml_value, .subjects = {{"text", ".5"}}}}},
    {"unknown_table",
     "lop.delay=1",
     {test::of_override("lop.delay"),
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "lop"}, {"meant", "loop"}}}}},
    {"unknown_key",
     "loop.dely=1",
     {test::of_override("loop.dely"),
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "dely"}, {"meant", "delay"}}}}},
    {"unknown_body_key",
     "body.motor.mas=1",
     {test::of_override("body.motor.mas"),
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "mas"}, {"meant", "mass"}}}}},
    {"key_without_table",
     "delay=1",
     {test::of_override("delay"),
      {.code = ProblemCode::unknown_key, .subjects = {{"name", "delay"}, {"homes", "[loop] or [loop.damper]"}}}}},
    {"key_of_a_value",
     "motion.x=1",
     {test::of_override("motion.x"), {.code = ProblemCode::value_and_no_table, .subjects = {{"name", "motion"}}}}},
    {"misspelt_body",
     "body.hanle.mass=1",
     {test::of_override("body.hanle.mass"),
      {.code = ProblemCode::no_such_name, .subjects = {{"what", "body"}, {"name", "hanle"}, {"meant", "handle"}}}}},
    {"no_such_body",
     "body.5.mass=1",
     {test::of_override("body.5.mass"),
      {.code = ProblemCode::no_such_name, .subjects = {{"what", "body"}, {"name", "5"}, {"bodies", "motor, handle"}}}}},
    {"which_body",
     "body.mass=1",
     {test::of_override("body.mass"),
      {.code = ProblemCode::in_several_tables,
       .evidence = {{"count", 2.0}},
       .subjects = {{"header", "[[body]]"}, {"example", "body.0.mass"}}}}},
    {"no_such_link",
     "link.1.damping=1",
     {test::of_override("link.1.damping"),
      {.code = ProblemCode::no_such_name, .evidence = {{"last", 0.0}}, .subjects = {{"what", "link"}, {"name", "1"}}}}},
    {"text_for_number",
     "body.handle.mass=abc",
     {test::of_override("body.handle.mass"),
      {.code = ProblemCode::of_other_type, .subjects = {{"text", "abc"}, {"needed", "measured"}, {"in", "kg"}}}}},
    {"unit_of_another_kind",
     "loop.delay=2 mm",
     {test::of_override("loop.delay"),
      {.code = ProblemCode::unit_of_other_measure, .subjects = {{"unit", "mm"}, {"measure", "time"}, {"in", "s"}}}}},
    {"quoted_unit_of_another_kind",
     "loop.delay=\"2 mm\"",
     {test::of_override("loop.delay"),
      {.code = ProblemCode::unit_of_other_measure, .subjects = {{"unit", "mm"}, {"measure", "time"}, {"in", "s"}}}}},
    {"impossible_value",
     "body.motor.mass=-3",
     {test::of_override("body.motor.mass"), {.code = ProblemCode::no_finite_number, .evidence = {{"value", -3.0}}}}},
    {"impossible_link",
     "link.stiffness=-1",
     {test::of_override("link.0.stiffness"), {.code = ProblemCode::no_finite_number, .evidence = {{"value", -1.0}}}}},
    {"value_for_table",
     "wall=3",
     {test::of_override("wall"),
      {.code = ProblemCode::of_other_type, .evidence = {{"number", 3.0}}, .subjects = {{"needed", "table"}}}}},
    {"body_of_loop",
     "loop.sensed=handel",
     {test::of_override("loop.sensed"),
      {.code = ProblemCode::no_such_name, .subjects = {{"what", "body"}, {"name", "handel"}, {"meant", "handle"}}}}},
    {"linear_inertia",
     "operator.inertia=1",
     {test::of_override("operator.inertia"), {.code = ProblemCode::inertia_of_linear_motion}}},
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
  test::expect_refused(device.error(),
                       {test::of_override("link.stiffness"),
                        {.code = ProblemCode::no_table_to_override, .subjects = {{"header", "[[link]]"}}}});
}

TEST(Overrides, LeaveErrorsOfTheFileToTheFile) {
  const std::vector<std::string> assignment{"wall.stiffness=3", "body.motor.mass=3"};
  const auto device = parse_device("wall = 3\nbody = 4\n", "f.toml", assignment);
  ASSERT_FALSE(device.has_value());
  EXPECT_EQ(device.error().place.file, "f.toml");
}

}  // namespace
}  // namespace zwidth
