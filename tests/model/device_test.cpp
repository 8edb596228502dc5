#include "zwidth/model/device.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

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
    EXPECT_NE(std::string(error.what()).find("wrist"), std::string::npos) << error.what();
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
    ASSERT_EQ(error.problems().size(), 1U);
    EXPECT_EQ(error.problems()[0].place.key, "body.motor.mass");
    ASSERT_TRUE(error.problems()[0].problem.has_value());
    EXPECT_EQ(error.problems()[0].problem->code, ProblemCode::no_finite_number);
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
  ProblemCode code;
  std::optional<double> first = std::nullopt;  // number that it names
};

class ImpossibleDevice : public testing::TestWithParam<Impossible> {};

TEST_P(ImpossibleDevice, IsFound) {
  DeviceParameters device = two_bodies();
  GetParam().change(device);
  const auto problem = find_problem(device);
  ASSERT_TRUE(problem.has_value());
  EXPECT_EQ(problem->key, GetParam().key);
  ASSERT_TRUE(problem->problem.has_value());
  EXPECT_EQ(problem->problem->code, GetParam().code);
  if (const std::optional<double> first = GetParam().first) {
    ASSERT_FALSE(problem->problem->evidence.empty());
    const double value = problem->problem->evidence.front().value;
    EXPECT_TRUE(value == *first || (std::isnan(value) && std::isnan(*first))) << value;
  }
  EXPECT_FALSE(problem->allowed.empty());
  EXPECT_THROW(Device{device}, Error);
}

std::vector<Impossible> impossible() {
  using enum ProblemCode;
  return {
      {"no_bodies", [](auto& d) { d.bodies.clear(); }, "body", no_body_at_all},
      {"control_character_in_name", [](auto& d) { d.name = "a\tb"; }, "name", control_character},
      {"long_name", [](auto& d) { d.name = std::string(201, 'x'); }, "name", too_many_bytes, 201.0},
      {"empty_body_name", [](auto& d) { d.bodies[1].name = ""; }, "body.1.name", name_empty},
      {"same_body_name", [](auto& d) { d.bodies[1].name = "motor"; }, "body.1.name", names_two_bodies},
      {"zero_mass", [](auto& d) { d.bodies[0].mass = 0.0; }, "body.motor.mass", no_finite_number, 0.0},
      {"nan_mass", [](auto& d) { d.bodies[0].mass = nan_value; }, "body.motor.mass", no_finite_number, nan_value},
      {"infinite_mass", [](auto& d) { d.bodies[0].mass = infinity; }, "body.motor.mass", no_finite_number, infinity},
      {"huge_mass", [](auto& d) { d.bodies[0].mass = 1e31; }, "body.motor.mass", not_between, 1e+31},
      {"tiny_mass", [](auto& d) { d.bodies[0].mass = 1e-31; }, "body.motor.mass", not_between, 1e-31},
      {"negative_damping", [](auto& d) { d.bodies[1].damping = -1.0; }, "body.handle.damping", no_finite_number, -1.0},
      {"negative_ground_stiffness", [](auto& d) { d.bodies[1].stiffness = -1.0; }, "body.handle.stiffness",
       no_finite_number, -1.0},
      {"negative_coulomb", [](auto& d) { d.bodies[1].coulomb = -1.0; }, "body.handle.coulomb", no_finite_number, -1.0},
      {"link_beyond_bodies", [](auto& d) { d.links[0].second = 2; }, "link.0.between", no_body_number, 2.0},
      {"self_link", [](auto& d) { d.links[0].second = 0; }, "link.0.between", tied_to_itself},
      {"negative_link", [](auto& d) { d.links[0].damping = -1.0; }, "link.0.damping", no_finite_number, -1.0},
      {"slack_link", [](auto& d) { d.links[0].stiffness = d.links[0].damping = 0.0; }, "link.0.stiffness",
       link_of_nothing},
      {"no_links", [](auto& d) { d.links.clear(); }, "body.handle", body_not_connected},
      {"two_islands",
       [](auto& d) {
         d.bodies.push_back({.name = "c", .mass = 1.0});
         d.bodies.push_back({.name = "d", .mass = 1.0});
         d.links.push_back({.first = 3, .second = 2, .stiffness = 1.0});
       },
       "body.c", body_not_connected},
      {"too_many_links", [](auto& d) { d.links.resize(1001, d.links[0]); }, "link", stands_too_often, 1001.0},
      {"actuated_beyond_bodies", [](auto& d) { d.loop.actuated = 2; }, "loop.actuated", no_body_number, 2.0},
      {"sensed_beyond_bodies", [](auto& d) { d.loop.sensed = 9; }, "loop.sensed", no_body_number, 9.0},
      {"held_beyond_bodies", [](auto& d) { d.loop.held = 2; }, "loop.held", no_body_number, 2.0},
      {"zero_sampling_period", [](auto& d) { d.loop.sampling_period = 0.0; }, "loop.sampling_period", no_finite_number,
       0.0},
      {"negative_delay", [](auto& d) { d.loop.delay = -1e-3; }, "loop.delay", no_finite_number, -0.001},
      {"endless_delay", [](auto& d) { d.loop.delay = 10.01; }, "loop.delay", delay_of_too_many_periods, 10.01},
      {"no_whole_part",
       [](auto& d) {
         d.loop.damper = LoopDamper{3e-4, {}};
       },
       "loop.damper.sampling_period", no_whole_ratio, 3e-4},
      {"no_whole_multiple",
       [](auto& d) {
         d.loop.damper = LoopDamper{2.6e-3, {}};
       },
       "loop.damper.sampling_period", no_whole_ratio, 2.6e-3},
      {"too_fast_damper",
       [](auto& d) {
         d.loop.damper = LoopDamper{1e-3 / 1001, {}};
       },
       "loop.damper.sampling_period", no_whole_ratio, 1e-3 / 1001},
      {"zero_damper_period",
       [](auto& d) {
         d.loop.damper = LoopDamper{0.0, {}};
       },
       "loop.damper.sampling_period", no_finite_number, 0.0},
      {"negative_damper_delay",
       [](auto& d) {
         d.loop.damper = LoopDamper{1e-4, -1e-4};
       },
       "loop.damper.delay", no_finite_number, -1e-4},
      {"endless_damper_delay",
       [](auto& d) {
         d.loop.damper = LoopDamper{1e-4, 1.001};
       },
       "loop.damper.delay", delay_of_too_many_periods, 1.001},
      {"filters_of_both",
       [](auto& d) {
         d.loop.damper = LoopDamper{1e-4, {}};
         d.wall.filters.push_back({.kind = WallFilter::Kind::low_pass, .frequency_hz = 60.0});
       },
       "wall.filter", filters_beside_damper_loop},
      {"negative_time_constant", [](auto& d) { d.actuator.time_constant = -1.0; }, "actuator.time_constant",
       no_finite_number, -1.0},
      {"zero_force_limit", [](auto& d) { d.actuator.force_limit = 0.0; }, "actuator.force_limit", no_finite_number,
       0.0},
      {"negative_resolution", [](auto& d) { d.sensor.resolution = -1.0; }, "sensor.resolution", no_finite_number, -1.0},
      {"negative_wall", [](auto& d) { d.wall.stiffness = -1.0; }, "wall.stiffness", no_finite_number, -1.0},
      {"negative_wall_damping", [](auto& d) { d.wall.damping = -1.0; }, "wall.damping", no_finite_number, -1.0},
      {"nan_filter", [](auto& d) { d.wall.velocity_filter_hz = nan_value; }, "wall.velocity_filter_hz",
       no_finite_number, nan_value},
      {"negative_operator", [](auto& d) { d.user.stiffness = -1.0; }, "operator.stiffness", no_finite_number, -1.0},
      {"bodies_and_transfer_function",
       [](auto& d) {
         d.transfer_function = {{1.0}, {1.0, 0.0}};
       },
       "body", beside_transfer_function},
      {"links_and_transfer_function",
       [](auto& d) {
         d = transfer_function();
         d.links.resize(1);
       },
       "link", beside_transfer_function},
      {"body_of_transfer_function",
       [](auto& d) {
         d = transfer_function();
         d.loop.held = 1;
       },
       "loop", beside_transfer_function},
      {"operator_of_transfer_function",
       [](auto& d) {
         d = transfer_function();
         d.user.mass = 1.0;
       },
       "operator", beside_transfer_function},
      {"too_high_degree",
       [](auto& d) {
         d = transfer_function();
         d.transfer_function->denominator.resize(102, 1.0);
       },
       "transfer_function.denominator", number_of_coefficients, 102.0},
      {"not_strictly_proper",
       [](auto& d) {
         d = transfer_function();
         d.transfer_function->numerator = {1.0, 0.0, 0.0};
       },
       "transfer_function.numerator", degree_not_lower, 2.0},
      {"constant_denominator",
       [](auto& d) {
         d = transfer_function();
         d.transfer_function->denominator = {1.0};
       },
       "transfer_function.numerator", degree_not_lower, 0.0},
      {"empty_denominator",
       [](auto& d) {
         d = transfer_function();
         d.transfer_function->denominator.clear();
       },
       "transfer_function.denominator", number_of_coefficients, 0.0},
      {"infinite_coefficient",
       [](auto& d) {
         d = transfer_function();
         d.transfer_function->denominator[1] = -infinity;
       },
       "transfer_function.denominator", coefficient_out_of_range, -infinity},
  };
}

INSTANTIATE_TEST_SUITE_P(Device, ImpossibleDevice, testing::ValuesIn(impossible()),
                         [](const auto& test) { return test.param.name; });

TEST(Device, TooManyBodiesAreRefusedAtOnce) {
  DeviceParameters device = two_bodies();
  device.bodies.resize(101, device.bodies[0]);
  const auto problem = find_problem(device);
  ASSERT_TRUE(problem && problem->problem);
  EXPECT_EQ(*problem->problem, (Problem{.code = ProblemCode::stands_too_often,
                                        .evidence = {{"count", 101.0}, {"most", 100.0}},
                                        .subjects = {{"what", "bodies"}}}));
}

}  // namespace
}  // namespace zwidth
