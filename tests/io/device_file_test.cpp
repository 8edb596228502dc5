#include "zwidth/io/device_file.hpp"

#include <gtest/gtest.h>

#include "io/device_texts.hpp"

namespace zwidth {
namespace {

/// The device of a text that must be good.
DeviceParameters read(const std::string& text) {
  const auto device = parse_device(text, "test.toml");
  if (!device) throw std::runtime_error(device.error().str());
  return device->parameters();
}

TEST(DeviceFile, ReadsEveryKey) {
  const DeviceParameters device = read(full_device_text);
  EXPECT_EQ(device.name, "LHIfAM, translational axis");
  EXPECT_EQ(device.motion, Motion::linear);
  ASSERT_EQ(device.bodies.size(), 2U);
  EXPECT_EQ(device.bodies[0].name, "motor");
  EXPECT_EQ(device.bodies[0].mass, 0.3);
  EXPECT_EQ(device.bodies[0].damping, 0.1);
  EXPECT_EQ(device.bodies[0].stiffness, 2.0);
  EXPECT_EQ(device.bodies[0].coulomb, 0.25);
  EXPECT_EQ(device.bodies[1].name, "handle");
  EXPECT_EQ(device.bodies[1].mass, 5.1);
  EXPECT_EQ(device.bodies[1].damping, 3.4);
  EXPECT_EQ(device.bodies[1].stiffness, 0.0);
  EXPECT_EQ(device.bodies[1].coulomb, 0.0);
  ASSERT_EQ(device.links.size(), 1U);
  EXPECT_EQ(device.links[0].first, 0U);
  EXPECT_EQ(device.links[0].second, 1U);
  EXPECT_EQ(device.links[0].stiffness, 79.5e3);
  EXPECT_EQ(device.links[0].damping, 15.0);
  EXPECT_FALSE(device.transfer_function.has_value());
  EXPECT_EQ(device.loop.actuated, 0U);
  EXPECT_EQ(device.loop.sensed, 1U);
  EXPECT_EQ(device.loop.held, 0U);
  EXPECT_EQ(device.loop.sampling_period, 1e-3);
  EXPECT_EQ(device.loop.delay, 0.25e-3);
  EXPECT_EQ(device.actuator.time_constant, 2e-4);
  EXPECT_EQ(device.actuator.force_limit, 20.0);
  EXPECT_EQ(device.sensor.resolution, 3.14e-6);
  EXPECT_EQ(device.wall.stiffness, 5000.0);
  EXPECT_EQ(device.wall.damping, 5.0);
  EXPECT_EQ(device.wall.velocity_filter_hz, 50.0);
  EXPECT_EQ(device.user.mass, 0.5);
  EXPECT_EQ(device.user.damping, 6.0);
  EXPECT_EQ(device.user.stiffness, 130.0);
}

TEST(DeviceFile, LeftOutKeysHaveTheirDefaults) {
  const DeviceParameters device = read(two_body_text);
  EXPECT_EQ(device.name, "test");  // of the file
  EXPECT_EQ(device.motion, Motion::linear);
  EXPECT_EQ(device.loop.actuated, 0U);
  EXPECT_EQ(device.loop.sensed, 0U);
  EXPECT_EQ(device.loop.held, 1U);
  EXPECT_EQ(device.loop.delay, 0.0);
  EXPECT_EQ(device.links[0].damping, 0.0);
  EXPECT_EQ(device.actuator.time_constant, 0.0);
  EXPECT_FALSE(device.actuator.force_limit.has_value());
  EXPECT_FALSE(device.wall.stiffness.has_value());
  EXPECT_EQ(device.wall.velocity_filter_hz, 0.0);
  EXPECT_EQ(device.user.mass, 0.0);
}

TEST(DeviceFile, InertiaIsMassOfRotaryMotion) {
  const DeviceParameters device = read(
      "motion = \"rotary\"\n[[body]]\nname = \"a\"\ninertia = 2e-3\n[loop]\nsampling_period = 1e-3\n"
      "[operator]\ninertia = 1e-3\n");
  EXPECT_EQ(device.motion, Motion::rotary);
  EXPECT_EQ(device.bodies[0].mass, 2e-3);
  EXPECT_EQ(device.user.mass, 1e-3);
}

TEST(DeviceFile, ReadsATransferFunction) {
  const DeviceParameters device =
      read("[transfer_function]\nnumerator = [0, 1]\ndenominator = [1, 2.5, 0]\n[loop]\nsampling_period = 1e-3\n");
  ASSERT_TRUE(device.transfer_function.has_value());
  EXPECT_EQ(device.transfer_function->numerator, (std::vector<double>{0.0, 1.0}));
  EXPECT_EQ(device.transfer_function->denominator, (std::vector<double>{1.0, 2.5, 0.0}));
  EXPECT_TRUE(device.bodies.empty());
}

TEST(DeviceFile, AnyTomlSpellingDoes) {
  const DeviceParameters device = read(
      "\xEF\xBB\xBF"
      "body = [{name = 'a.b', mass = 1_000}, {name = \"é\", mass = 0x10}] # inline tables\r\n"
      "link = [{between = ['a.b', \"\\u00e9\"], damping = +3e-1}]\r\n"
      "loop.sampling_period = 1e-3\r\n");
  EXPECT_EQ(device.bodies[0].name, "a.b");
  EXPECT_EQ(device.bodies[0].mass, 1000.0);
  EXPECT_EQ(device.bodies[1].mass, 16.0);
  EXPECT_EQ(device.links[0].damping, 0.3);
}

TEST(InputProblem, IsOneLineWhateverTheFileSays) {
  const InputProblem error{{"a\nb.toml", 3, 7, "body.\x1b[31m.mass"}, "is -1\r", "must be > 0", {}};
  EXPECT_EQ(error.str(), "a\\x0Ab.toml:3:7: body.\\x1B[31m.mass: is -1\\x0D; must be > 0");
  EXPECT_EQ((InputProblem{{.file = "an override"}, "is wrong", "", {}}).str(), "an override: is wrong");
}

}  // namespace
}  // namespace zwidth
