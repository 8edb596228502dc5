// The [driver] table of a device file: read, written, refused with its place.
#include <gtest/gtest.h>

#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "io/problem_data.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

const std::string linear = "[[body]]\nname = \"a\"\nmass = 1\n[loop]\nsampling_period = 0.01\n[driver]\n";
const std::string rotary =
    "motion = \"rotary\"\n[[body]]\nname = \"a\"\ninertia = 1\n[loop]\nsampling_period = 0.01\n[driver]\n";

InputProblem refusal_of_drive(const std::string& text) {
  const auto device = parse_device(text, "f.toml");
  return device ? InputProblem{{}, "", "", {}} : InputProblem(device.error());
}

TEST(DeviceDriver, IsReadInUnits) {
  const auto device = parse_device(linear +
                                       "travel = \"25 mm\"\ngear = 2\nsign = -1\ntorque_constant = \"50 mN m/A\"\n"
                                       "torque_per_volt = \"0.02 N m/V\"\nid = 1\ncommand = \"A\"\nbaud = 921600\n",
                                   "f.toml");
  ASSERT_TRUE(device) << device.error().str();
  const MotorDrive& drive = device->parameters().driver.value();
  EXPECT_DOUBLE_EQ(drive.position_per_turn(), -0.0125);
  EXPECT_DOUBLE_EQ(drive.torque_constant.value(), 0.05);
  EXPECT_DOUBLE_EQ(drive.torque_per_volt.value(), 0.02);
  EXPECT_EQ(drive.id, 1);
  EXPECT_EQ(drive.command, "A");
  EXPECT_EQ(drive.baud, 921600);
}

TEST(DeviceDriver, EmptyTurnsWithTheDevice) {
  const auto device = parse_device(rotary, "f.toml");
  ASSERT_TRUE(device) << device.error().str();
  const MotorDrive& drive = device->parameters().driver.value();
  EXPECT_DOUBLE_EQ(drive.position_per_turn(), 2.0 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(drive.torque_per_force(), 1.0);
  const std::vector<std::string> overrides{"driver.travel=1 turn", "driver.gear=3"};
  EXPECT_DOUBLE_EQ(parse_device(rotary, "f.toml", overrides)->parameters().driver->position_per_turn(),
                   2.0 * std::numbers::pi / 3.0);
}

// Every row of the table in docs/device_file.md is a key that is read, at the ends of what it allows.
TEST(DeviceDriver, HasTheKeysOfItsDocument) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/docs/device_file.md");
  std::vector<std::string> keys;
  bool is_inside = false;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("| **`")) is_inside = line.starts_with("| **`[driver]`**");
    if (is_inside && line.starts_with("| `")) keys.push_back(line.substr(3, line.find('`', 3) - 3));
  }
  EXPECT_EQ(keys, (std::vector<std::string>{"travel", "gear", "sign", "force_sign", "torque_constant",
                                            "torque_per_volt", "id", "command", "baud"}));
  for (const std::string least : {"travel = 1e-9\n", "gear = 0.001\n", "sign = -1\n", "force_sign = -1\n",
                                  "torque_constant = 1e-6\n", "torque_per_volt = 1e-6\n", "id = 0\n", "id = 253\n",
                                  "command = \"z\"\n", "baud = 1200\n", "baud = 4000000\n"}) {
    EXPECT_EQ(refusal_of_drive(rotary + least).str(), "") << least;
  }
}

TEST(DeviceDriver, IsWrittenAsItWasRead) {
  for (const std::string text :
       {"travel = 0.025\nsign = -1\nforce_sign = -1\nbaud = 115200\n", "travel = 1\nid = 7\ncommand = \"z\"\n"}) {
    const auto device = parse_device(linear + text, "f.toml");
    ASSERT_TRUE(device) << device.error().str();
    const std::string written = write_device(device->parameters());
    const auto again = parse_device(written, "g.toml");
    ASSERT_TRUE(again) << again.error().str();
    EXPECT_EQ(write_device(again->parameters()), written);
    EXPECT_EQ(again->parameters().driver->sign, device->parameters().driver->sign);
    EXPECT_EQ(again->parameters().driver->force_sign, device->parameters().driver->force_sign);
    EXPECT_EQ(again->parameters().driver->baud, device->parameters().driver->baud);
    EXPECT_EQ(again->parameters().driver->id, device->parameters().driver->id);
    EXPECT_EQ(again->parameters().driver->command, device->parameters().driver->command);
  }
}

TEST(DeviceDriver, IsRefusedWithItsPlace) {
  test::expect_refused(refusal_of_drive(linear),
                       {{"f.toml", 6, 1, "driver.travel"}, {.code = ProblemCode::travel_per_turn_missing}});
  test::expect_refused(refusal_of_drive(linear + "travel = 1\ngears = 2\n"),
                       {{"f.toml", 8, 1, "driver.gears"},
                        {.code = ProblemCode::unknown_key, .subjects = {{"name", "gears"}, {"meant", "gear"}}}});
  test::expect_refused(refusal_of_drive(linear + "travel = \"1 turn\"\n"),
                       {{"f.toml", 7, 10, "driver.travel"},
                        {.code = ProblemCode::unit_of_other_measure,
                         .subjects = {{"unit", "turn"}, {"measure", "length"}, {"in", "m"}}}});
  test::expect_refused(refusal_of_drive(rotary + "torque_constant = \"5 A\"\n"),
                       {{"f.toml", 8, 19, "driver.torque_constant"},
                        {.code = ProblemCode::unit_of_other_measure,
                         .subjects = {{"unit", "A"}, {"measure", "torque constant"}, {"in", "N m/A"}}}});
  test::expect_refused(
      refusal_of_drive(rotary + "sign = 2\n"),
      {{"f.toml", 8, 8, "driver.sign"},
       {.code = ProblemCode::not_one_of, .evidence = {{"value", 2.0}}, .subjects = {{"choices", "1 or -1"}}}});
  test::expect_refused(
      refusal_of_drive(rotary + "gear = 0\n"),
      {{"f.toml", 8, 8, "driver.gear"}, {.code = ProblemCode::no_finite_number, .evidence = {{"value", 0.0}}}});
  test::expect_refused(refusal_of_drive(rotary + "id = 1.5\n"),
                       {{"f.toml", 8, 6, "driver.id"},
                        {.code = ProblemCode::no_whole_number, .evidence = {{"value", 1.5}, {"most", 1e9}}}});
  test::expect_refused(refusal_of_drive(rotary + "id = 254\n"),
                       {{"f.toml", 8, 6, "driver.id"},
                        {.code = ProblemCode::not_between, .evidence = {{"value", 254.0}, {"whole", 1.0}}}});
  test::expect_refused(refusal_of_drive(rotary + "baud = 1e30\n"),
                       {{"f.toml", 8, 8, "driver.baud"},
                        {.code = ProblemCode::no_whole_number, .evidence = {{"value", 1e+30}, {"most", 1e9}}}});
  test::expect_refused(refusal_of_drive(rotary + "baud = nan\n"),
                       {{"f.toml", 8, 8, "driver.baud"},
                        {.code = ProblemCode::no_whole_number, .evidence = {{"value", std::nan("")}, {"most", 1e9}}}});
  test::expect_refused(refusal_of_drive(rotary + "command = \"MM\"\n"),
                       {{"f.toml", 8, 11, "driver.command"}, {.code = ProblemCode::no_letter}});
}

}  // namespace
}  // namespace zwidth
