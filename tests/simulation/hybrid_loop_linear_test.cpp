// Loops without friction against an integration of Newton's equations by Boost.Odeint in long double, over 1 s.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "simulation/reference_loop.hpp"
#include "simulation/simulated_devices.hpp"

namespace zwidth {
namespace {

using test::held_by_a_user;
using test::lhifam_parameters;
using test::pushed_by;
using test::spring_wall;
using test::starting_at;
using test::with_delay;
using test::with_lag;

constexpr double relative_tolerance = 1e-9;  // of the largest value of each position and velocity

struct Case {
  std::string name;
  DeviceParameters device;
  HybridLoopOptions options;
};

void PrintTo(const Case& each, std::ostream* stream) { *stream << each.name; }

UserForce sine(double amplitude, double frequency_hz, double start) {
  UserForce force;
  force.kind = UserForce::Kind::sine;
  force.amplitude = amplitude;
  force.frequency = 2.0 * std::numbers::pi * frequency_hz;
  force.start = start;
  return force;
}

UserForce of_kind(UserForce::Kind kind, double amplitude, double start) {
  UserForce force;
  force.kind = kind;
  force.amplitude = amplitude;
  force.start = start;
  return force;
}

UserForce recorded() {
  UserForce force;
  force.kind = UserForce::Kind::recorded;
  force.start = 0.0123;
  force.period = 3.7e-3;
  for (int k = 0; k < 200; ++k) force.samples.push_back(3.0 * std::sin(0.31 * k) + 0.02 * k);
  return force;
}

std::vector<Case> cases() {
  const std::vector<double> both = {1e-3, 1e-3};
  DeviceParameters saturated = lhifam_parameters();
  saturated.actuator.force_limit = 2.0;
  DeviceParameters encoder = lhifam_parameters();
  encoder.sensor.resolution = 3.14e-6;
  DeviceParameters grounded = lhifam_parameters();
  grounded.bodies[1].stiffness = 300.0;
  HybridLoopOptions one_sided = starting_at(spring_wall(6000.0, 3.0), {-1e-3, -1e-3}, {0.05, 0.05});
  one_sided.controller.contact = ControllerOptions::Contact::unilateral;
  one_sided.user_force = of_kind(UserForce::Kind::step, 4.0, 0.2);
  HybridLoopOptions elsewhere = spring_wall(5000.0, 2.0);
  elsewhere.controller.position = 7e-3;
  return {
      {"rigid", test::rigid_parameters(), starting_at(spring_wall(5000.0), {1e-3})},
      {"rigid_unstable", test::rigid_parameters(), starting_at(spring_wall(9000.0), {1e-3})},
      {"lhifam", lhifam_parameters(), starting_at(spring_wall(5000.0), both)},
      {"lhifam_from_a_bent_cable", lhifam_parameters(), starting_at(spring_wall(5000.0), {0.0, 1e-3}, {0.3, -0.2})},
      {"handle_sensed", test::handle_sensed(lhifam_parameters()), starting_at(spring_wall(5000.0), both)},
      {"three_bodies", test::three_body_parameters(), starting_at(spring_wall(4000.0), {1e-3, 2e-3, -1e-3})},
      {"lag", with_lag(lhifam_parameters(), 2e-3), starting_at(spring_wall(2000.0), both)},
      {"short_lag", with_lag(lhifam_parameters(), 5e-5), starting_at(spring_wall(5000.0), both)},
      {"user_holds", held_by_a_user(lhifam_parameters()), starting_at(spring_wall(5000.0), both)},
      {"grounded", grounded, starting_at(spring_wall(3000.0), both)},
      {"fractional_delay", with_delay(lhifam_parameters(), 0.25e-3), starting_at(spring_wall(4000.0), both)},
      {"whole_delay", with_delay(lhifam_parameters(), 2e-3), starting_at(spring_wall(1000.0), both)},
      {"long_fractional_delay", with_delay(lhifam_parameters(), 7.83e-3), starting_at(spring_wall(300.0), both)},
      {"damper", lhifam_parameters(), starting_at(spring_wall(5000.0, 5.0), both)},
      {"filtered_damper", lhifam_parameters(), starting_at(spring_wall(5000.0, 8.0, 60.0), both)},
      {"saturation", saturated, starting_at(spring_wall(5000.0), both)},
      {"encoder", encoder, starting_at(spring_wall(5000.0), both)},
      {"wall_elsewhere", lhifam_parameters(), elsewhere},
      {"one_sided_wall", lhifam_parameters(), one_sided},
      {"step", lhifam_parameters(), pushed_by(spring_wall(5000.0), of_kind(UserForce::Kind::step, 5.0, 0.1003))},
      {"ramp", lhifam_parameters(), pushed_by(spring_wall(5000.0), of_kind(UserForce::Kind::ramp, 8.0, 0.0))},
      {"sine", with_delay(lhifam_parameters(), 0.25e-3), pushed_by(spring_wall(4000.0), sine(5.0, 3.3, 0.05021))},
      {"recorded", lhifam_parameters(), pushed_by(spring_wall(5000.0), recorded())},
      {"free", lhifam_parameters(), starting_at({}, {0.0, 0.0}, {0.1, 0.1})},
      {"everything", with_lag(with_delay(held_by_a_user(test::three_body_parameters()), 1.37e-3), 3e-4),
       pushed_by(starting_at(spring_wall(1500.0, 4.0, 100.0), {1e-3, 1e-3, 1e-3}), sine(3.0, 7.1, 0.2))},
  };
}

class LinearLoop : public testing::TestWithParam<Case> {};

TEST_P(LinearLoop, MovesAsAnIndependentIntegrationSays) {
  const Case& given = GetParam();
  HybridLoop ours(Device(given.device), given.options);
  test::ReferenceLoop reference(given.device, given.options);
  test::expect_same_motion(ours, reference, given.device.bodies.size(), relative_tolerance);
}

INSTANTIATE_TEST_SUITE_P(HybridLoop, LinearLoop, testing::ValuesIn(cases()),
                         [](const auto& each) { return each.param.name; });

}  // namespace
}  // namespace zwidth
