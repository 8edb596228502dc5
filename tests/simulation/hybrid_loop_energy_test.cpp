// Work in = stored + dissipated, along the exact motion.

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "simulation/continuous_motion.hpp"
#include "simulation/simulated_devices.hpp"
#include "zwidth/simulation/simulate.hpp"

namespace zwidth {
using namespace internal;
namespace {

using test::lhifam_parameters;
using test::simulation_of;
using test::spring_wall;
using test::starting_at;
using test::with_friction;

constexpr double tolerance = 1e-9;  // of all energy that was stored, supplied or dissipated

double stored(const DeviceParameters& device, const ContinuousMotion& motion) {
  double energy = 0.0;
  for (std::size_t i = 0; i < device.bodies.size(); ++i) {
    const double q = motion.position(i);
    const double v = motion.velocity(i);
    energy += 0.5 * device.bodies[i].mass * v * v + 0.5 * device.bodies[i].stiffness * q * q;
    if (i != device.loop.held) continue;
    energy += 0.5 * device.user.mass * v * v + 0.5 * device.user.stiffness * q * q;
  }
  for (const Link& link : device.links) {
    const double extension = motion.position(link.first) - motion.position(link.second);
    energy += 0.5 * link.stiffness * extension * extension;
  }
  return energy;
}

struct Power {
  double dissipated = 0.0;
  double user = 0.0;
};

Power power(const DeviceParameters& device, const ContinuousMotion& motion) {
  Power power;
  for (std::size_t i = 0; i < device.bodies.size(); ++i) {
    const double v = motion.velocity(i);
    power.dissipated += device.bodies[i].damping * v * v + device.bodies[i].coulomb * std::abs(v);
    if (i != device.loop.held) continue;
    power.dissipated += device.user.damping * v * v;
    power.user += motion.outside_force() * v;
  }
  for (const Link& link : device.links) {
    const double rate = motion.velocity(link.first) - motion.velocity(link.second);
    power.dissipated += link.damping * rate * rate;
  }
  return power;
}

struct Energy {
  double dissipated = 0.0;
  double user = 0.0;
};

// Simpson's rule over parts without stick-slip instants; a part that has one is halved until it is too short to matter.
void move(const DeviceParameters& device, ContinuousMotion& motion, double duration, Energy& energy) {
  constexpr double shortest = 1e-11;
  ContinuousMotion probe = motion;
  probe.advance(duration);
  if (probe.events() != motion.events() && duration > shortest) {
    move(device, motion, 0.5 * duration, energy);
    move(device, motion, 0.5 * duration, energy);
    return;
  }
  const Power before = power(device, motion);
  motion.advance(0.5 * duration);
  const Power middle = power(device, motion);
  motion.advance(0.5 * duration);
  const Power after = power(device, motion);
  energy.dissipated += duration / 6.0 * (before.dissipated + 4.0 * middle.dissipated + after.dissipated);
  energy.user += duration / 6.0 * (before.user + 4.0 * middle.user + after.user);
}

// Runs the loop, and beside it the continuous device under the same forces, whose power is integrated.
void expect_balance(const DeviceParameters& device, const HybridLoopOptions& options) {
  constexpr int parts = 32;
  const double period = device.loop.sampling_period;
  HybridLoop loop(Device(device), options);
  const bool pushed = options.user_force.kind == UserForce::Kind::sine;
  const double rate = options.user_force.frequency;
  ContinuousMotion motion(Device(device), pushed ? OutsideForce{true, rate, rate} : OutsideForce{}, {period});
  const std::vector<double> rest(device.bodies.size(), 0.0);
  const auto& positions = options.initial_position.empty() ? rest : options.initial_position;
  const auto& velocities = options.initial_velocity.empty() ? rest : options.initial_velocity;
  motion.set_motion(positions.data(), velocities.data());
  if (pushed) motion.set_outside(0.0, options.user_force.amplitude);
  const double at_start = stored(device, motion);
  Energy energy;
  for (int k = 0; k < 1000; ++k) {
    loop.step();
    motion.set_command(loop.command());
    for (int part = 0; part < parts; ++part) move(device, motion, period / parts, energy);
    ASSERT_NEAR(motion.position(0), loop.position(0), 1e-13);
  }
  const double balance = loop.work() + energy.user + at_start - stored(device, motion) - energy.dissipated;
  const double scale = at_start + energy.dissipated + std::abs(energy.user) + std::abs(loop.work());
  EXPECT_GT(scale, 0.0);
  EXPECT_LE(std::abs(balance), tolerance * scale) << "balance " << balance << " of " << scale;
}

TEST(Energy, BalancesWithoutFriction) {
  expect_balance(lhifam_parameters(), starting_at(spring_wall(5000.0), {1e-3, 1e-3}));
}

TEST(Energy, BalancesWithADamperAndAUser) {
  DeviceParameters device = test::held_by_a_user(lhifam_parameters());
  device.bodies[0].stiffness = 200.0;
  expect_balance(device, starting_at(spring_wall(5000.0, 6.0, 80.0), {1e-3, 2e-3}, {0.1, -0.1}));
}

TEST(Energy, BalancesWithFrictionThatBringsBothBodiesToRest) {
  expect_balance(with_friction(lhifam_parameters(), 0.5, 1.0), starting_at(spring_wall(5000.0), {3e-3, 3e-3}));
}

// Its fastest motion turns 24 times per sample: the loop's steps are halved further, the series beside it takes 24 parts.
TEST(Energy, BalancesWithFrictionAcrossAStiffLink) {
  DeviceParameters device = with_friction(lhifam_parameters(), 0.05, 0.1);
  device.links[0].stiffness = 1e8;
  device.links[0].damping = 100.0;
  expect_balance(device, starting_at(spring_wall(5000.0), {3e-3, 3e-3}));
}

TEST(Energy, BalancesWithFrictionThroughReversals) {
  expect_balance(with_friction(lhifam_parameters(), 0.05, 0.1), starting_at(spring_wall(9500.0), {3e-3, 3e-3}));
}

TEST(Energy, BalancesWhereTheUserDragsStickingBodies) {
  HybridLoopOptions options = spring_wall(2000.0);
  options.user_force.kind = UserForce::Kind::sine;
  options.user_force.amplitude = 9.0;
  options.user_force.frequency = 7.0;
  expect_balance(with_friction(lhifam_parameters(), 1.0, 2.0), options);
}

TEST(GeneratedEnergy, AnUnstableWallGivesWithoutEnd) {
  SimulationOptions options = simulation_of(starting_at(spring_wall(9500.0), {1e-3, 1e-3}));
  options.duration = 5.0;
  const Simulation shorter = simulate(Device(lhifam_parameters()), options);
  options.duration = 20.0;
  const Simulation longer = simulate(Device(lhifam_parameters()), options);
  EXPECT_GT(*shorter.generated_energy, 0.0);
  EXPECT_GT(*longer.generated_energy, 2.0 * *shorter.generated_energy);
  EXPECT_GE(longer.peak_generated_energy, *longer.generated_energy);
}

// A wall that is so soft and sampled so fast that it is a spring: it returns what it took.
TEST(GeneratedEnergy, AContinuousSpringGivesNothing) {
  DeviceParameters device = test::rigid_parameters();
  device.loop.sampling_period = 1e-6;
  SimulationOptions options = simulation_of(starting_at(spring_wall(1000.0), {1e-3}));
  options.duration = 1.0;
  const Simulation run = simulate(Device(device), options);
  const double held_at_start = 0.5 * 1000.0 * 1e-6;
  EXPECT_LE(run.peak_generated_energy, 1e-3 * held_at_start);
  EXPECT_GE(*run.generated_energy, -1e-3 * held_at_start);
}

// The virtual damper takes: a passive wall's energy is negative.
TEST(GeneratedEnergy, ADampedWallTakes) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies[0].damping = 30.0;
  SimulationOptions options = simulation_of(starting_at(spring_wall(2000.0, 20.0), {1e-3}));
  const Simulation run = simulate(Device(device), options);
  EXPECT_LT(*run.generated_energy, 0.0);
  // 1 mm of 2 kN/m is 1 mJ; half a sample of delay gives some of it before the damper takes more.
  EXPECT_LT(run.peak_generated_energy, 1e-5);
}

// Beyond the force limit the spring holds F p - F²/(2 K) only: a slow push in and out then gives nothing.
TEST(GeneratedEnergy, ASaturatedSpringHoldsLess) {
  DeviceParameters device = test::rigid_parameters();
  device.loop.sampling_period = 1e-5;
  device.actuator.force_limit = 1.0;
  SimulationOptions options = simulation_of(starting_at(spring_wall(1000.0), {5e-3}));
  options.duration = 0.5;
  const Simulation run = simulate(Device(device), options);
  const double held_at_start = 1.0 * 5e-3 - 0.5 * 1.0 / 1000.0;
  EXPECT_LE(run.peak_generated_energy, 1e-2 * held_at_start);
  EXPECT_GE(*run.generated_energy, -1e-2 * held_at_start);
}

}  // namespace
}  // namespace zwidth
