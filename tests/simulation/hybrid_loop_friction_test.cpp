// Coulomb friction against the same independent integration, whose stick-slip instants are found by bisection.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "simulation/reference_loop.hpp"
#include "simulation/simulated_devices.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using test::lhifam_parameters;
using test::pushed_by;
using test::spring_wall;
using test::starting_at;
using test::with_friction;

constexpr double relative_tolerance = 1e-9;  // of the largest value of each position and velocity

struct Case {
  std::string name;
  DeviceParameters device;
  HybridLoopOptions options;
};

void PrintTo(const Case& each, std::ostream* stream) { *stream << each.name; }

UserForce slow_sine(double amplitude, double frequency_hz) {
  UserForce force;
  force.kind = UserForce::Kind::sine;
  force.amplitude = amplitude;
  force.frequency = 2.0 * std::numbers::pi * frequency_hz;
  return force;
}

std::vector<Case> cases() {
  const std::vector<double> both = {3e-3, 3e-3};
  DeviceParameters rigid = test::rigid_parameters();
  rigid.bodies[0].coulomb = 0.7;
  DeviceParameters three = test::three_body_parameters();
  three.bodies[0].coulomb = 0.2;
  three.bodies[1].coulomb = 0.5;
  three.bodies[2].coulomb = 0.3;
  DeviceParameters everything = test::with_lag(
      test::with_delay(test::held_by_a_user(with_friction(lhifam_parameters(), 0.4, 0.9)), 1.37e-3), 3e-4);
  everything.sensor.resolution = 3.14e-6;
  everything.actuator.force_limit = 8.0;
  HybridLoopOptions one_sided = starting_at(spring_wall(6000.0, 3.0), {-1e-3, -1e-3}, {0.05, 0.05});
  one_sided.controller.contact = ControllerOptions::Contact::unilateral;
  one_sided.user_force = slow_sine(6.0, 1.5);
  return {
      {"rigid_comes_to_rest", rigid, starting_at(spring_wall(5000.0), {3e-3})},
      {"both_come_to_rest", with_friction(lhifam_parameters(), 0.5, 1.0), starting_at(spring_wall(5000.0), both)},
      {"motor_alone", with_friction(lhifam_parameters(), 0.5, 0.0), starting_at(spring_wall(5000.0), both)},
      {"handle_alone", with_friction(lhifam_parameters(), 0.0, 1.5), starting_at(spring_wall(5000.0), both)},
      {"little_friction_reverses", with_friction(lhifam_parameters(), 0.02, 0.02),
       starting_at(spring_wall(7000.0), both)},
      {"both_stick_and_are_dragged_on", with_friction(lhifam_parameters(), 1.0, 2.0),
       pushed_by(spring_wall(2000.0), slow_sine(9.0, 1.0))},
      {"opposite_starts", with_friction(lhifam_parameters(), 0.5, 0.8),
       starting_at(spring_wall(5000.0), both, {0.2, -0.2})},
      {"three_bodies", three, starting_at(spring_wall(4000.0), {2e-3, 2e-3, 2e-3})},
      {"fractional_delay", test::with_delay(with_friction(lhifam_parameters(), 0.3, 0.5), 0.25e-3),
       starting_at(spring_wall(4000.0), both)},
      {"lag_delay_user_encoder_limit", everything,
       pushed_by(starting_at(spring_wall(1500.0, 4.0, 100.0), both), slow_sine(5.0, 2.3))},
      {"one_sided_wall", with_friction(lhifam_parameters(), 0.4, 0.6), one_sided},
      {"unstable_wall", with_friction(lhifam_parameters(), 0.05, 0.1), starting_at(spring_wall(9500.0), both)},
  };
}

class FrictionLoop : public testing::TestWithParam<Case> {};

TEST_P(FrictionLoop, MovesAsAnIndependentIntegrationSays) {
  const Case& given = GetParam();
  HybridLoop ours(Device(given.device), given.options);
  test::ReferenceLoop reference(given.device, given.options);
  test::expect_same_motion(ours, reference, given.device.bodies.size(), relative_tolerance);
  EXPECT_GT(reference.events(), 3U);
  EXPECT_EQ(ours.friction_events(), reference.events());
  EXPECT_EQ(ours.overloaded_steps(), 0U);
}

INSTANTIATE_TEST_SUITE_P(HybridLoop, FrictionLoop, testing::ValuesIn(cases()),
                         [](const auto& each) { return each.param.name; });

TEST(FrictionLoop, BothBodiesStickTogetherAndStayThere) {
  const DeviceParameters device = with_friction(lhifam_parameters(), 0.5, 1.0);
  HybridLoop loop(Device(device), starting_at(spring_wall(5000.0), {3e-3, 3e-3}));
  for (int k = 0; k < 2000; ++k) loop.step();
  EXPECT_TRUE(loop.sticks(0));
  EXPECT_TRUE(loop.sticks(1));
  const double motor = loop.position(0);
  const double handle = loop.position(1);
  for (int k = 0; k < 1000; ++k) loop.step();
  EXPECT_EQ(loop.position(0), motor);
  EXPECT_EQ(loop.position(1), handle);
  EXPECT_EQ(loop.velocity(0), 0.0);
  // What holds them is at most F_c: the wall's force less the cable's on the motor, the cable's on the handle.
  const double cable = 79.5e3 * (motor - handle);
  EXPECT_LE(std::abs(loop.command() - cable), 0.5 * (1.0 + 1e-9));
  EXPECT_LE(std::abs(cable), 1.0 * (1.0 + 1e-9));
}

// One body under a ramp that meets Coulomb friction: everything in closed form.
TEST(FrictionLoop, ABodyUnderARampBreaksAwayWhenTheForceReachesItsFriction) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies[0] = {"body", 2.0, 0.0, 0.0, 0.75};
  UserForce ramp;
  ramp.kind = UserForce::Kind::ramp;
  ramp.amplitude = 3.0;
  ramp.start = 0.0125;
  HybridLoop loop(Device(device), pushed_by({}, ramp));
  const double breaks = ramp.start + 0.75 / 3.0;
  for (int k = 1; k <= 500; ++k) {
    loop.step();
    const double since = std::max(0.0, loop.time() - breaks);
    EXPECT_NEAR(loop.velocity(0), 3.0 * since * since / 2.0 / 2.0, 1e-13) << loop.time();
    EXPECT_NEAR(loop.position(0), 3.0 * since * since * since / 6.0 / 2.0, 1e-14) << loop.time();
    EXPECT_EQ(loop.sticks(0), loop.time() < breaks) << loop.time();
  }
  EXPECT_EQ(loop.friction_events(), 1U);
}

// A body thrown along: stops after v/(F_c/m), having come v²/(2 F_c/m).
TEST(FrictionLoop, AThrownBodyStopsWhereItsEnergyIsSpent) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies[0] = {"body", 2.0, 0.0, 0.0, 0.5};
  HybridLoop loop(Device(device), starting_at({}, {0.0}, {0.111}));
  for (int k = 0; k < 1000; ++k) loop.step();
  EXPECT_NEAR(loop.position(0), 0.111 * 0.111 / (2.0 * 0.25), 1e-15);
  EXPECT_EQ(loop.velocity(0), 0.0);
  EXPECT_EQ(loop.friction_events(), 1U);
}

TEST(FrictionLoop, MirroredStartsGiveMirroredMotions) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (int trial = 0; trial < 20; ++trial) {
    SCOPED_TRACE(trial);
    const DeviceParameters device =
        with_friction(lhifam_parameters(), 0.5 + 0.4 * uniform(random), 0.8 + 0.5 * uniform(random));
    const std::vector<double> start = {3e-3 * uniform(random), 3e-3 * uniform(random)};
    const std::vector<double> velocity = {0.1 * uniform(random), 0.1 * uniform(random)};
    HybridLoop loop(Device(device), starting_at(spring_wall(6000.0), start, velocity));
    HybridLoop mirrored(Device(device),
                        starting_at(spring_wall(6000.0), {-start[0], -start[1]}, {-velocity[0], -velocity[1]}));
    for (int k = 0; k < 500; ++k) {
      loop.step();
      mirrored.step();
      for (std::size_t i = 0; i < 2; ++i) {
        ASSERT_EQ(loop.position(i), -mirrored.position(i)) << k;
        ASSERT_EQ(loop.velocity(i), -mirrored.velocity(i)) << k;
      }
    }
  }
}

TEST(FrictionLoop, FrictionSoSmallThatItCannotMatterChangesNothing) {
  HybridLoop with(Device(with_friction(lhifam_parameters(), 1e-14, 1e-14)),
                  starting_at(spring_wall(5000.0), {1e-3, 1e-3}));
  HybridLoop without(Device(lhifam_parameters()), starting_at(spring_wall(5000.0), {1e-3, 1e-3}));
  for (int k = 0; k < 1000; ++k) {
    with.step();
    without.step();
    ASSERT_NEAR(with.position(1), without.position(1), 1e-13);
  }
}

TEST(FrictionLoop, RefusesFrictionOnMoreThanSixBodies) {
  DeviceParameters chain;
  for (int i = 0; i < 7; ++i) chain.bodies.push_back({"body" + std::to_string(i), 1.0, 1.0, 0.0, 0.1});
  for (std::size_t i = 0; i < 6; ++i) chain.links.push_back({i, i + 1, 1e4, 1.0});
  chain.loop = {0, 0, 6, 1e-3, 0.0};
  EXPECT_THROW(HybridLoop(Device(chain), {}), Error);
  chain.bodies[3].coulomb = 0.0;
  EXPECT_NO_THROW(HybridLoop(Device(chain), {}));
}

TEST(FrictionLoop, RefusesAMotionTooFastToFollow) {
  DeviceParameters device = with_friction(lhifam_parameters(), 0.1, 0.0);
  device.links[0].stiffness = 1e18;
  EXPECT_THROW(HybridLoop(Device(device), spring_wall(5000.0)), Error);
  device.bodies[0].coulomb = 0.0;
  EXPECT_NO_THROW(HybridLoop(Device(device), spring_wall(5000.0)));
}

}  // namespace
}  // namespace zwidth
