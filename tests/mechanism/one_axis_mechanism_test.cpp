// A device of one axis written as a mechanism: the numbers of its bodies and links.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "campaign.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
namespace {

constexpr double same = 1e-10;  // relative

class Random {
 public:
  explicit Random(unsigned seed) : random_(seed) {}
  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  double decades(double low, double high) { return low * std::pow(high / low, between(0.0, 1.0)); }
  bool happens(double share) { return between(0.0, 1.0) < share; }

 private:
  std::mt19937 random_;
};

struct SameDevice {
  DeviceParameters bodies;
  DeviceParameters mechanism;
};

// What stands beside bodies and links, and beside a mechanism.
DeviceParameters loop_and_wall(Random& random) {
  DeviceParameters all;
  all.loop.sampling_period = random.decades(2e-4, 2e-3);
  if (random.happens(0.5)) all.loop.delay = all.loop.sampling_period * random.between(0.0, 2.0);
  all.wall.stiffness = random.decades(50.0, 2000.0);
  if (random.happens(0.5)) all.wall.damping = random.decades(0.1, 5.0);
  if (random.happens(0.3)) all.actuator.time_constant = random.decades(1e-4, 1e-3);
  if (random.happens(0.3)) {
    all.user = {.mass = random.decades(0.1, 1.0),
                .damping = random.decades(1.0, 10.0),
                .stiffness = random.decades(50.0, 500.0)};
  }
  return all;
}

// Slides one behind another, by cables.
SameDevice chain(unsigned seed) {
  Random random(seed);
  const auto count = static_cast<std::size_t>(random.between(1.0, 4.99));
  SameDevice device{loop_and_wall(random), {}};
  std::string slides;
  std::string cables;
  for (std::size_t i = 0; i < count; ++i) {
    const Body body{.name = fmt::format("body {}", i),
                    .mass = random.decades(0.05, 5.0),
                    .damping = random.decades(0.05, 5.0),
                    .stiffness = random.happens(0.1) ? random.decades(1.0, 100.0) : 0.0};
    device.bodies.bodies.push_back(body);
    slides += fmt::format(
        "<body><joint name='{}' type='slide' axis='1 0 0' damping='{}' stiffness='{}'/>"
        "<inertial pos='0 0 0' mass='{}' diaginertia='1 1 1'/>{}</body>",
        body.name, body.damping, body.stiffness, body.mass, i + 1 == count ? "<site name='tip' pos='0 0.1 0'/>" : "");
    if (i == 0) continue;
    const Link link{
        .first = i - 1, .second = i, .stiffness = random.decades(1e3, 3e5), .damping = random.decades(0.5, 50.0)};
    device.bodies.links.push_back(link);
    cables += fmt::format(
        "<fixed stiffness='{}' damping='{}'><joint joint='body {}' coef='1'/><joint joint='body {}' "
        "coef='-1'/></fixed>",
        link.stiffness, link.damping, i - 1, i);
  }
  if (!cables.empty()) cables = "<tendon>" + cables + "</tendon>";
  const std::size_t sensed = random.happens(0.6) ? 0 : count - 1;
  device.mechanism = device.bodies;
  device.mechanism.bodies.clear();
  device.mechanism.links.clear();
  device.bodies.loop.held = count - 1;
  device.bodies.loop.sensed = sensed;
  MechanismDirection& along = device.mechanism.mechanism.emplace();
  along.normal = {random.happens(0.5) ? 1.0 : -1.0, 0.0, 0.0};
  along.mechanism.tip = "tip";
  along.mechanism.encoders = {fmt::format("body {}", sensed)};
  along.mechanism.text = "<mujoco><worldbody>" + slides + "</worldbody>" + cables +
                         "<actuator><motor joint='body 0'/></actuator></mujoco>";
  return device;
}

// A paddle and a motor behind it, with a cable or without.
SameDevice transmission(unsigned seed) {
  Random random(seed);
  SameDevice device{loop_and_wall(random), {}};
  device.mechanism = device.bodies;
  const double lever = random.between(0.05, 0.3);
  const double square = lever * lever;
  const double inertia = random.decades(1e-3, 2e-2);
  const double damping = random.decades(1e-3, 2e-2);
  Transmission motor{.joint = "j",
                     .ratio = random.between(1.0, 15.0),
                     .inertia = random.decades(1e-5, 2e-4),
                     .motor_damping = random.decades(1e-5, 2e-4)};
  const double turns = motor.ratio * motor.ratio;
  Body paddle{.name = "paddle", .mass = inertia / square, .damping = damping / square};
  if (random.happens(0.7)) {
    motor.stiffness = random.decades(50.0, 2000.0);
    motor.damping = random.decades(1e-2, 0.3);
    device.bodies.bodies = {
        {.name = "motor", .mass = motor.inertia * turns / square, .damping = motor.motor_damping * turns / square},
        paddle};
    device.bodies.links = {
        {.first = 0, .second = 1, .stiffness = motor.stiffness / square, .damping = motor.damping / square}};
    device.bodies.loop.held = 1;
  } else {
    paddle.mass += motor.inertia * turns / square;
    paddle.damping += motor.motor_damping * turns / square;
    device.bodies.bodies = {paddle};
  }
  MechanismDirection& along = device.mechanism.mechanism.emplace();
  along.normal = {0.0, 1.0, 0.0};
  along.mechanism.tip = "tip";
  along.mechanism.transmissions = {motor};
  if (random.happens(0.5)) {
    along.mechanism.encoders = {"j"};
    device.bodies.loop.sensed = device.bodies.loop.held;
  }
  along.mechanism.text = fmt::format(
      "<mujoco><worldbody><body><joint name='j' axis='0 0 1' damping='{}'/><inertial pos='0 0 0' mass='1' "
      "diaginertia='{} {} {}'/><site name='tip' pos='{} 0 0'/></body></worldbody></mujoco>",
      damping, inertia, inertia, inertia, lever);
  return device;
}

void expect_same(double found, double expected, double tolerance = same) {
  if (found == expected || (std::isnan(found) && std::isnan(expected))) return;
  EXPECT_NEAR(found / expected, 1.0, tolerance);
}

void expect_same(const std::optional<double>& found, const std::optional<double>& expected) {
  ASSERT_EQ(found.has_value(), expected.has_value());
  if (found) expect_same(*found, *expected);
}

void expect_same(const std::optional<HolderLimit>& found, const std::optional<HolderLimit>& expected) {
  ASSERT_EQ(found.has_value(), expected.has_value());
  if (!found) return;
  expect_same(found->critical_stiffness, expected->critical_stiffness);
  expect_same(found->critical_damping, expected->critical_damping);
}

void expect_same(const Analysis& found, const Analysis& expected) {
  EXPECT_EQ(found.critical.status, expected.critical.status);
  expect_same(found.critical.stiffness, expected.critical.stiffness);
  ASSERT_EQ(found.critical.crossovers.size(), expected.critical.crossovers.size());
  for (std::size_t i = 0; i < found.critical.crossovers.size(); ++i) {
    expect_same(found.critical.crossovers[i].stiffness, expected.critical.crossovers[i].stiffness);
    expect_same(found.critical.crossovers[i].frequency, expected.critical.crossovers[i].frequency);
  }
  expect_same(std::optional(found.limits.nobody), std::optional(expected.limits.nobody));
  expect_same(found.limits.user, expected.limits.user);
  expect_same(found.limits.any_user, expected.limits.any_user);
  ASSERT_EQ(found.wall.has_value(), expected.wall.has_value());
  if (!found.wall) return;
  EXPECT_EQ(found.wall->stable, expected.wall->stable);
  expect_same(found.wall->spectral_radius, expected.wall->spectral_radius);
  expect_same(found.wall->gain_margin, expected.wall->gain_margin);
  expect_same(found.wall->phase_margin, expected.wall->phase_margin);
  expect_same(found.wall->delay_margin, expected.wall->delay_margin);
}

// Property: both ways of writing one device have all their limits and margins in common.
TEST(OneAxisMechanism, HasTheNumbersOfItsBodies) {
  for (unsigned seed = 0; seed < test::by_tier(4U, 50U); ++seed) {
    SCOPED_TRACE(seed);
    const SameDevice device = seed % 2 == 0 ? chain(seed) : transmission(seed);
    const Device mechanism = device_of_mechanism(device.mechanism);
    expect_same(analyze(mechanism), analyze(Device(device.bodies)));
  }
}

}  // namespace
}  // namespace zwidth
