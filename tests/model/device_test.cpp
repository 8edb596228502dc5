#include "zwidth/model/device.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

DeviceParameters two_bodies() {
  DeviceParameters device;
  device.name = "rig";
  device.bodies = {{.name = "motor", .mass = 0.3, .damping = 0.1}, {.name = "handle", .mass = 5.1, .damping = 3.4}};
  device.links = {{.first = 0, .second = 1, .stiffness = 79.5e3, .damping = 15.0}};
  device.loop = {.actuated = 0, .sensed = 0, .held = 1, .sampling_period = 1e-3, .delay = 0.0};
  return device;
}

DeviceParameters transfer_function() {
  DeviceParameters device;
  device.transfer_function = {.numerator = {1.0}, .denominator = {1.0, 2.0, 0.0}};
  device.loop.sampling_period = 1e-3;
  return device;
}

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Device, HoldsGoodParameters) {
  EXPECT_FALSE(find_problem(two_bodies()).has_value());
  EXPECT_FALSE(find_problem(transfer_function()).has_value());
  const Device device(two_bodies());
  EXPECT_EQ(device.name(), "rig");
  EXPECT_TRUE(device.has_bodies());
  EXPECT_EQ(device.body_index("handle"), 1U);
  EXPECT_FALSE(Device(transfer_function()).has_bodies());
}

TEST(Device, RefusesAnUnknownBody) {
  try {
    (void)Device(two_bodies()).body_index("wrist");
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::no_such_body);
    EXPECT_STREQ(error.what(), "the device has no body \"wrist\"");
  }
}

TEST(Device, ThrowsWhatFindProblemFinds) {
  auto device = two_bodies();
  device.bodies[0].mass = -0.3;
  try {
    (void)Device(device);
    FAIL() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
    EXPECT_STREQ(error.what(), "body.motor.mass: is -0.3; must be a finite number > 0");
  }
}

TEST(Device, ValuesAtTheEndsOfTheirRangesAreGood) {
  auto device = two_bodies();
  device.bodies[0].mass = 1e-30;
  device.bodies[1].mass = 1e30;
  device.links[0].stiffness = 0.0;
  device.loop.delay = 10.0;  // 10000 samples
  device.wall.stiffness = 0.0;
  EXPECT_FALSE(find_problem(device).has_value());
}

struct Impossible {
  std::string name;
  std::function<void(DeviceParameters&)> change;
  std::string key;
  std::string what;
};

class ImpossibleDevice : public testing::TestWithParam<Impossible> {};

TEST_P(ImpossibleDevice, IsFound) {
  DeviceParameters device = two_bodies();
  GetParam().change(device);
  const auto problem = find_problem(device);
  ASSERT_TRUE(problem.has_value());
  EXPECT_EQ(problem->key, GetParam().key);
  EXPECT_EQ(problem->what, GetParam().what);
  EXPECT_FALSE(problem->allowed.empty());
  EXPECT_THROW(Device{device}, Error);
}

const Impossible impossible[] = {
    {"no_bodies", [](auto& d) { d.bodies.clear(); }, "body",
     "is missing: the device has no [[body]] and no [transfer_function]"},
    {"control_character_in_name", [](auto& d) { d.name = "a\tb"; }, "name", "has a control character"},
    {"long_name", [](auto& d) { d.name = std::string(201, 'x'); }, "name", "has 201 bytes"},
    {"empty_body_name", [](auto& d) { d.bodies[1].name = ""; }, "body.1.name", "is empty"},
    {"same_body_name", [](auto& d) { d.bodies[1].name = "motor"; }, "body.1.name", "\"motor\" names two bodies"},
    {"zero_mass", [](auto& d) { d.bodies[0].mass = 0.0; }, "body.motor.mass", "is 0"},
    {"nan_mass", [](auto& d) { d.bodies[0].mass = nan_value; }, "body.motor.mass", "is nan"},
    {"infinite_mass", [](auto& d) { d.bodies[0].mass = infinity; }, "body.motor.mass", "is inf"},
    {"huge_mass", [](auto& d) { d.bodies[0].mass = 1e31; }, "body.motor.mass", "is 1e+31"},
    {"tiny_mass", [](auto& d) { d.bodies[0].mass = 1e-31; }, "body.motor.mass", "is 1e-31"},
    {"negative_damping", [](auto& d) { d.bodies[1].damping = -1.0; }, "body.handle.damping", "is -1"},
    {"negative_ground_stiffness", [](auto& d) { d.bodies[1].stiffness = -1.0; }, "body.handle.stiffness", "is -1"},
    {"negative_coulomb", [](auto& d) { d.bodies[1].coulomb = -1.0; }, "body.handle.coulomb", "is -1"},
    {"link_beyond_bodies", [](auto& d) { d.links[0].second = 2; }, "link.0.between", "has body number 2 of 2"},
    {"self_link", [](auto& d) { d.links[0].second = 0; }, "link.0.between", "ties \"motor\" to itself"},
    {"negative_link", [](auto& d) { d.links[0].damping = -1.0; }, "link.0.damping", "is -1"},
    {"slack_link", [](auto& d) { d.links[0].stiffness = d.links[0].damping = 0.0; }, "link.0.stiffness",
     "and damping are both 0"},
    {"no_links", [](auto& d) { d.links.clear(); }, "body.handle", "is tied to nothing"},
    {"two_islands",
     [](auto& d) {
       d.bodies.push_back({.name = "c", .mass = 1.0});
       d.bodies.push_back({.name = "d", .mass = 1.0});
       d.links.push_back({.first = 3, .second = 2, .stiffness = 1.0});
     },
     "body.c", "is not connected to body \"motor\""},
    {"too_many_links", [](auto& d) { d.links.resize(1001, d.links[0]); }, "link", "stands 1001 times"},
    {"actuated_beyond_bodies", [](auto& d) { d.loop.actuated = 2; }, "loop.actuated", "is body number 2 of 2"},
    {"sensed_beyond_bodies", [](auto& d) { d.loop.sensed = 9; }, "loop.sensed", "is body number 9 of 2"},
    {"held_beyond_bodies", [](auto& d) { d.loop.held = 2; }, "loop.held", "is body number 2 of 2"},
    {"zero_sampling_period", [](auto& d) { d.loop.sampling_period = 0.0; }, "loop.sampling_period", "is 0"},
    {"negative_delay", [](auto& d) { d.loop.delay = -1e-3; }, "loop.delay", "is -0.001"},
    {"endless_delay", [](auto& d) { d.loop.delay = 10.01; }, "loop.delay", "is 10.01 s, 10010 sampling periods"},
    {"negative_time_constant", [](auto& d) { d.actuator.time_constant = -1.0; }, "actuator.time_constant", "is -1"},
    {"zero_force_limit", [](auto& d) { d.actuator.force_limit = 0.0; }, "actuator.force_limit", "is 0"},
    {"negative_resolution", [](auto& d) { d.sensor.resolution = -1.0; }, "sensor.resolution", "is -1"},
    {"negative_wall", [](auto& d) { d.wall.stiffness = -1.0; }, "wall.stiffness", "is -1"},
    {"negative_wall_damping", [](auto& d) { d.wall.damping = -1.0; }, "wall.damping", "is -1"},
    {"nan_filter", [](auto& d) { d.wall.velocity_filter_hz = nan_value; }, "wall.velocity_filter_hz", "is nan"},
    {"negative_operator", [](auto& d) { d.user.stiffness = -1.0; }, "operator.stiffness", "is -1"},
    {"bodies_and_transfer_function",
     [](auto& d) {
       d.transfer_function = {{1.0}, {1.0, 0.0}};
     },
     "body", "stands beside a transfer function"},
    {"links_and_transfer_function",
     [](auto& d) {
       d = transfer_function();
       d.links.resize(1);
     },
     "link", "stands beside a transfer function"},
    {"body_of_transfer_function",
     [](auto& d) {
       d = transfer_function();
       d.loop.held = 1;
     },
     "loop", "names a body beside a transfer function"},
    {"operator_of_transfer_function",
     [](auto& d) {
       d = transfer_function();
       d.user.mass = 1.0;
     },
     "operator", "stands beside a transfer function"},
    {"too_high_degree",
     [](auto& d) {
       d = transfer_function();
       d.transfer_function->denominator.resize(102, 1.0);
     },
     "transfer_function.denominator", "has 102 coefficients"},
    {"not_strictly_proper",
     [](auto& d) {
       d = transfer_function();
       d.transfer_function->numerator = {1.0, 0.0, 0.0};
     },
     "transfer_function.numerator", "has degree 2 under a denominator of degree 2"},
    {"constant_denominator",
     [](auto& d) {
       d = transfer_function();
       d.transfer_function->denominator = {1.0};
     },
     "transfer_function.numerator", "has degree 0 under a denominator of degree 0"},
    {"empty_denominator",
     [](auto& d) {
       d = transfer_function();
       d.transfer_function->denominator.clear();
     },
     "transfer_function.denominator", "is empty"},
    {"infinite_coefficient",
     [](auto& d) {
       d = transfer_function();
       d.transfer_function->denominator[1] = -infinity;
     },
     "transfer_function.denominator", "has the coefficient -inf"},
};

INSTANTIATE_TEST_SUITE_P(Device, ImpossibleDevice, testing::ValuesIn(impossible),
                         [](const auto& test) { return test.param.name; });

TEST(Device, TooManyBodiesAreRefusedAtOnce) {
  DeviceParameters device = two_bodies();
  device.bodies.resize(101, device.bodies[0]);
  EXPECT_EQ(find_problem(device)->what, "stands 101 times");
}

}  // namespace
}  // namespace zwidth
