// What simulate() says of a run, on runs whose outcome is known.

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "simulation/simulated_devices.hpp"
#include "zwidth/error.hpp"
#include "zwidth/simulation/simulate.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;
using test::lhifam_parameters;
using test::pushed_by;
using test::simulation_of;
using test::spring_wall;
using test::starting_at;

Simulation run(const DeviceParameters& device, const HybridLoopOptions& loop, double duration) {
  return simulate(Device(device), simulation_of(loop, duration));
}

UserForce step(double force, double start) {
  UserForce user;
  user.kind = UserForce::Kind::step;
  user.amplitude = force;
  user.start = start;
  return user;
}

TEST(Verdict, AStableWallSettles) {
  DeviceParameters device = lhifam_parameters();
  device.bodies[1].damping = 30.0;
  const Simulation result = run(device, starting_at(spring_wall(5000.0), {1e-3, 1e-3}), 6.0);
  EXPECT_EQ(result.verdict, LoopVerdict::settles);
  ASSERT_TRUE(result.settling_time.has_value());
  EXPECT_GT(*result.settling_time, 0.5);
  EXPECT_LT(*result.settling_time, 3.0);
  EXPECT_NEAR(result.peak_penetration, 1e-3, 1e-9);
  EXPECT_EQ(result.samples, 6000U);
}

TEST(Verdict, ADecayThatIsNotOverHasNoSettlingTime) {
  const Simulation result = run(lhifam_parameters(), starting_at(spring_wall(5000.0), {1e-3, 1e-3}), 6.0);
  EXPECT_EQ(result.verdict, LoopVerdict::settles);
  ASSERT_TRUE(result.growth_rate.has_value());
  EXPECT_LT(*result.growth_rate, 0.0);
  EXPECT_FALSE(result.settling_time.has_value());
}

// Growth rate and frequency are the dominant closed-loop pole's.
TEST(Verdict, AnUnstableWallGrowsAsItsPoleSays) {
  for (const double stiffness : {7000.0, 9500.0, 12000.0}) {
    SCOPED_TRACE(stiffness);
    const DeviceParameters device = lhifam_parameters();
    const Simulation result = run(device, starting_at(spring_wall(stiffness), {1e-3, 1e-3}), 10.0);
    EXPECT_EQ(result.verdict, stiffness > 8848.7 ? LoopVerdict::unstable : LoopVerdict::settles);
    std::complex<double> dominant = 0.0;
    Wall wall;
    wall.stiffness = stiffness;
    for (const auto& pole : closed_loop_poles_minus_one(sample(state_space(Device(device)), {1e-3, 0.0}), wall)) {
      if (std::abs(1.0 + pole) > std::abs(dominant)) dominant = 1.0 + pole;
    }
    EXPECT_NEAR(*result.growth_rate, std::log(std::abs(dominant)) / 1e-3, 0.01);
    EXPECT_NEAR(result.oscillation->frequency, std::abs(std::arg(dominant)) / 1e-3, 0.02);
  }
}

TEST(Verdict, DivergenceEndsTheRun) {
  SimulationOptions options = simulation_of(starting_at(spring_wall(40000.0), {1e-3, 1e-3}));
  options.duration = 10.0;
  options.divergence = 0.5;
  const Simulation result = simulate(Device(lhifam_parameters()), options);
  EXPECT_EQ(result.verdict, LoopVerdict::unstable);
  EXPECT_LT(result.samples, 10000U);
  EXPECT_EQ(result.trajectory.time.size(), result.samples);
  EXPECT_GT(std::abs(result.final_position), 0.4);
}

TEST(Verdict, EvenAnOverflowingRunIsUnstable) {
  SimulationOptions options = simulation_of(starting_at(spring_wall(1e12), {1e-3, 1e-3}));
  options.divergence = std::numeric_limits<double>::max();
  EXPECT_EQ(simulate(Device(lhifam_parameters()), options).verdict, LoopVerdict::unstable);
}

// Above K_CR the force limit holds the oscillation at a size that does not depend on the start.
TEST(Verdict, AForceLimitMakesALimitCycle) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies[0].damping = 20.0;
  device.bodies[0].stiffness = 300.0;
  device.loop.delay = 3e-3;
  device.actuator.force_limit = 2.0;
  const Simulation small = run(device, starting_at(spring_wall(12000.0), {1e-4}), 40.0);
  const Simulation large = run(device, starting_at(spring_wall(12000.0), {3e-3}), 40.0);
  ASSERT_EQ(small.verdict, LoopVerdict::limit_cycle);
  ASSERT_EQ(large.verdict, LoopVerdict::limit_cycle);
  EXPECT_NEAR(small.oscillation->amplitude, large.oscillation->amplitude, 0.01 * large.oscillation->amplitude);
  EXPECT_NEAR(small.oscillation->frequency, large.oscillation->frequency, 0.01 * large.oscillation->frequency);
}

// Without its encoder the loop is stable; the encoder's step keeps it moving by about a step, whatever the start.
TEST(Verdict, AnEncoderMakesALimitCycleOfItsOwnSize) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies[0].damping = 2.0;
  device.loop.delay = 2e-3;
  EXPECT_GT(critical_stiffness(filtered_plant(Device(device))).stiffness, 700.0);
  EXPECT_EQ(run(device, starting_at(spring_wall(700.0), {1.3e-4}), 60.0).verdict, LoopVerdict::settles);
  std::vector<double> amplitudes;  // in steps
  for (const double resolution : {1e-4, 1e-6}) {
    device.sensor.resolution = resolution;
    const Simulation result = run(device, starting_at(spring_wall(700.0), {1.3 * resolution}), 60.0);
    EXPECT_EQ(result.verdict, LoopVerdict::limit_cycle);
    ASSERT_TRUE(result.oscillation.has_value());
    amplitudes.push_back(result.oscillation->amplitude / resolution);
  }
  EXPECT_GT(amplitudes[0], 0.5);
  EXPECT_LT(amplitudes[0], 2.0);
  EXPECT_NEAR(amplitudes[1], amplitudes[0], 1e-6);  // nothing else sets a scale
}

TEST(Verdict, AMotionWithinTheEncoderStepIsRest) {
  DeviceParameters device = test::rigid_parameters();
  device.sensor.resolution = 1e-3;
  device.bodies[0].stiffness = 1000.0;
  device.bodies[0].damping = 1e-3;
  const Simulation result = run(device, starting_at(spring_wall(0.0), {2e-4}), 10.0);
  EXPECT_EQ(result.verdict, LoopVerdict::settles);
  ASSERT_TRUE(result.oscillation.has_value());  // and yet it is told
  EXPECT_NEAR(result.oscillation->amplitude, 2e-4, 1e-5);
}

TEST(Verdict, FrictionBringsAnUnstableWallToRest) {
  const Simulation result =
      run(test::with_friction(lhifam_parameters(), 0.5, 1.0), starting_at(spring_wall(9500.0), {1e-3, 1e-3}), 5.0);
  EXPECT_EQ(result.verdict, LoopVerdict::settles);
  EXPECT_GT(result.friction_events, 0U);
  EXPECT_FALSE(result.oscillation.has_value());
}

TEST(Verdict, AFreeDeviceDrifts) {
  for (const double damping : {0.0, 3.5, 50.0}) {
    SCOPED_TRACE(damping);
    DeviceParameters device = test::rigid_parameters();
    device.bodies[0].damping = damping;
    EXPECT_EQ(run(device, starting_at({}, {0.0}, {0.2}), 2.0).verdict,
              damping < 50.0 ? LoopVerdict::drifts : LoopVerdict::settles);
    EXPECT_EQ(run(device, pushed_by({}, step(1.0, 0.0)), 2.0).verdict, LoopVerdict::drifts);
  }
}

TEST(Verdict, ADeviceThatBouncesOffAWallDrifts) {
  HybridLoopOptions options = starting_at(spring_wall(5000.0), {-1e-3, -1e-3}, {0.1, 0.1});
  options.controller.contact = ControllerOptions::Contact::unilateral;
  const Simulation result = run(lhifam_parameters(), options, 4.0);
  EXPECT_EQ(result.verdict, LoopVerdict::drifts);
  EXPECT_LT(result.final_position, -1e-2);
  EXPECT_GT(result.peak_penetration, 1e-3);
}

TEST(Verdict, AUserWhoPressesFindsTheWall) {
  DeviceParameters device = lhifam_parameters();
  device.bodies[1].damping = 30.0;
  HybridLoopOptions options = pushed_by(spring_wall(5000.0), step(5.0, 0.5));
  options.controller.contact = ControllerOptions::Contact::unilateral;
  const Simulation result = run(device, options, 6.0);
  EXPECT_EQ(result.verdict, LoopVerdict::settles);
  EXPECT_NEAR(result.final_position, 5.0 / 5000.0, 2e-5);
  EXPECT_GT(result.peak_penetration, 1.2e-3);
  EXPECT_LE(result.peak_penetration, 2.01e-3);
}

UserForce sine(double amplitude, double frequency_hz) {
  UserForce user;
  user.kind = UserForce::Kind::sine;
  user.amplitude = amplitude;
  user.frequency = 2.0 * pi * frequency_hz;
  return user;
}

// The steady amplitude of a linear loop is that of its frequency response.
TEST(Verdict, AUserWhoSwingsIsFollowedWithTheAmplitudeOfTheFrequencyResponse) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies[0] = {"body", 2.0, 20.0, 0.0, 0.0};
  device.loop.sampling_period = 1e-4;
  const double w = 2.0 * pi * 3.0;
  const Simulation result = run(device, pushed_by(spring_wall(1000.0), sine(5.0, 3.0)), 10.0);
  EXPECT_EQ(result.verdict, LoopVerdict::forced);
  ASSERT_TRUE(result.oscillation.has_value());
  EXPECT_NEAR(result.oscillation->frequency, w, 1e-12);
  // The hold is a delay of half a sample.
  const std::complex<double> wall = 1000.0 * std::polar(1.0, -w * 0.5e-4);
  const double expected = 5.0 / std::abs(std::complex<double>(-2.0 * w * w, 20.0 * w) + wall);
  EXPECT_NEAR(result.oscillation->amplitude, expected, 1e-5 * expected);
}

TEST(Verdict, ALightlyDampedLoopThatBeatsWithTheUserStillFollows) {
  EXPECT_EQ(run(lhifam_parameters(), pushed_by(spring_wall(5000.0), sine(5.0, 3.0)), 7.0).verdict, LoopVerdict::forced);
}

TEST(Verdict, AnUnstableWallIsNotHiddenByTheUser) {
  EXPECT_EQ(run(lhifam_parameters(), pushed_by(spring_wall(11000.0), sine(1.0, 3.0)), 10.0).verdict,
            LoopVerdict::unstable);
}

TEST(Verdict, AHeavilyDampedMotionWithoutCyclesSettles) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies[0].damping = 400.0;
  for (const double duration : {0.4, 0.6}) {
    EXPECT_EQ(run(device, starting_at(spring_wall(5000.0), {1e-3}), duration).verdict, LoopVerdict::settles)
        << duration;
  }
}

TEST(Verdict, ALongDelayGrowsInFewSwings) {
  const DeviceParameters device = test::with_delay(test::rigid_parameters(), 0.5);
  EXPECT_EQ(run(device, starting_at(spring_wall(500.0), {1e-3}), 3.0).verdict, LoopVerdict::unstable);
  // Under a ramp of force a free body runs away as a cube of time, and yet nothing is unstable.
  UserForce ramp;
  ramp.kind = UserForce::Kind::ramp;
  ramp.amplitude = 10.0;
  EXPECT_EQ(run(device, pushed_by({}, ramp), 3.0).verdict, LoopVerdict::drifts);
}

TEST(Verdict, TooShortARunIsUndecided) {
  EXPECT_EQ(run(lhifam_parameters(), starting_at(spring_wall(5000.0), {1e-3, 1e-3}), 0.3).verdict,
            LoopVerdict::undecided);
  EXPECT_EQ(run(lhifam_parameters(), starting_at(spring_wall(5000.0), {1e-3, 1e-3}), 0.01).verdict,
            LoopVerdict::undecided);
}

TEST(Simulate, KeepsWhatIsAskedFor) {
  SimulationOptions options = simulation_of(starting_at(spring_wall(5000.0), {1e-3, 2e-3}));
  options.duration = 0.1;
  options.keep_every = 7;
  const Simulation thin = simulate(Device(lhifam_parameters()), options);
  options.keep_every = 1;
  const Simulation full = simulate(Device(lhifam_parameters()), options);
  ASSERT_EQ(full.trajectory.time.size(), 100U);
  ASSERT_EQ(thin.trajectory.time.size(), 15U);
  for (std::size_t k = 0; k < 15; ++k) {
    EXPECT_EQ(thin.trajectory.time[k], full.trajectory.time[7 * k]);
    EXPECT_EQ(thin.trajectory.position[1][k], full.trajectory.position[1][7 * k]);
    EXPECT_EQ(thin.trajectory.command[k], full.trajectory.command[7 * k]);
    EXPECT_EQ(thin.trajectory.velocity[0][k], full.trajectory.velocity[0][7 * k]);
  }
  EXPECT_EQ(full.trajectory.position[0][0], 1e-3);
  EXPECT_EQ(full.trajectory.command[0], -5.0);
  EXPECT_EQ(full.trajectory.measured[0], 1e-3);
  options.keep_at_most = 15;
  EXPECT_EQ(simulate(Device(lhifam_parameters()), options).trajectory.time, thin.trajectory.time);
  options.keep_every = 0;
  EXPECT_TRUE(simulate(Device(lhifam_parameters()), options).trajectory.time.empty());
}

TEST(Simulate, ATransferFunctionMovesWhereItsWallIsElsewhere) {
  const DeviceParameters device = test::transfer_function_parameters({1.0}, {5.4, 3.5, 0.0}, 1e-3);
  HybridLoopOptions options = spring_wall(5000.0);
  options.controller.position = -1e-3;
  const Simulation result = run(device, options, 1.0);
  // The same motion as the rigid body's that starts 1 mm inside.
  const Simulation body = run(test::rigid_parameters(), starting_at(spring_wall(5000.0), {1e-3}), 1.0);
  for (std::size_t k = 0; k < 1000; ++k) {
    ASSERT_NEAR(result.trajectory.position[0][k] + 1e-3, body.trajectory.position[0][k], 1e-14);
  }
  EXPECT_TRUE(result.trajectory.velocity.empty());
}

TEST(Simulate, RefusesWhatItCannotDo) {
  const Device device(lhifam_parameters());
  const auto refused = [&device](const SimulationOptions& options) {
    EXPECT_THROW((void)simulate(device, options), Error);
  };
  SimulationOptions options;
  options.duration = 0.0;
  refused(options);
  options.duration = std::nan("");
  refused(options);
  options.duration = 1e9;
  refused(options);
  options = {};
  options.divergence = 0.0;
  refused(options);
  options = {};
  options.initial_position = {1.0};
  refused(options);
  options.initial_position = {1.0, std::nan("")};
  refused(options);
  options = {};
  options.controller = spring_wall(-1.0).controller;
  refused(options);
  options = {};
  options.user_force.kind = UserForce::Kind::sine;
  refused(options);
  options.user_force.kind = UserForce::Kind::recorded;
  refused(options);
  const Device transfer_function(test::transfer_function_parameters({1.0}, {1.0, 1.0, 0.0}, 1e-3));
  options = {};
  options.user_force.kind = UserForce::Kind::step;
  EXPECT_THROW((void)simulate(transfer_function, options), Error);
}

TEST(Simulate, ProgressEndsTheRunByThrowing) {
  struct Stop {};
  SimulationOptions options;
  options.duration = 100.0;
  options.initial_velocity = {0.1, 0.1};
  options.keep_every = 0;
  double last = -1.0;
  EXPECT_THROW((void)simulate(Device(lhifam_parameters()), options,
                              [&last](double fraction) {
                                EXPECT_GE(fraction, last);
                                last = fraction;
                                if (fraction > 0.5) throw Stop{};
                              }),
               Stop);
}

}  // namespace
}  // namespace zwidth
