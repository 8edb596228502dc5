// What simulate() decides and says besides the verdict: defaults, the linear answer, remarks, trust.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "simulation/simulated_devices.hpp"
#include "zwidth/error.hpp"
#include "zwidth/simulation/simulate.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;
using test::lhifam_parameters;
using test::simulation_of;
using test::spring_wall;
using test::starting_at;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double critical = 8848.70869499712;  // of LHIfAM's Table I

DeviceParameters lhifam_with_wall(double stiffness) {
  DeviceParameters device = lhifam_parameters();
  device.wall.stiffness = stiffness;
  return device;
}

UserForce step(double force) {
  UserForce user;
  user.kind = UserForce::Kind::step;
  user.amplitude = force;
  return user;
}

std::vector<std::string> whats(const Simulation& result) {
  std::vector<std::string> texts;
  for (const Remark& remark : result.remarks) texts.push_back(remark.what);
  return texts;
}

TEST(SimulationDefaults, TheDevicesOwnWallFromOneMillimetreInside) {
  const Simulation result = simulate(Device(lhifam_with_wall(5000.0)));
  EXPECT_EQ(result.verdict, LoopVerdict::settles);
  EXPECT_THAT(result.loop.initial_position, ElementsAre(1e-3, 1e-3));
  EXPECT_EQ(result.loop.controller.stiffness, 5000.0);
  EXPECT_NEAR(result.duration, 40.0 * 2.0 * pi / 38.5965268731856, 1e-9);
  EXPECT_THAT(result.remarks, IsEmpty());
  EXPECT_TRUE(result.trust.sound());
}

TEST(SimulationDefaults, DurationIsBoundedAndCountedFromTheUsersForce) {
  const Device device(lhifam_with_wall(5000.0));
  SimulationOptions options;
  options.user_force = step(1.0);
  options.user_force.start = 3.0;
  EXPECT_NEAR(simulate(device, options).duration, 3.0 + 40.0 * 2.0 * pi / 38.5965268731856, 1e-9);
  DeviceParameters fast = test::rigid_parameters();
  fast.loop.sampling_period = 1e-7;
  fast.wall.stiffness = 1.0;
  EXPECT_NEAR(simulate(Device(fast), {}).duration, 0.1, 1e-12);
}

TEST(SimulationOptions, MorePointsThanCanBeKeptAreRefused) {
  const Device device(lhifam_with_wall(5000.0));
  SimulationOptions options;
  options.duration = 5e6 * device.loop().sampling_period + 1.0;
  const auto problem = find_problem(options, device);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->member, "keep_every");
  EXPECT_EQ(problem->allowed, "2 or more: 5000000 points at most");
  options.keep_every = 2;
  EXPECT_FALSE(find_problem(options, device));
  options.keep_every = 1;
  options.keep_at_most = 0;
  EXPECT_EQ(find_problem(options, device)->member, "keep_at_most");
}

TEST(SimulationDefaults, ATransferFunctionsWallBeginsOneMillimetreBehindIt) {
  DeviceParameters device = test::transfer_function_parameters({1.0}, {5.4, 3.5, 0.0}, 1e-3);
  device.wall.stiffness = 5000.0;
  EXPECT_EQ(simulate(Device(device)).loop.controller.position, -1e-3);
  SimulationOptions options;
  options.wall_position = 0.0;
  EXPECT_EQ(find_problem(options, Device(device))->member, "wall_position");
}

TEST(SimulationLinear, IsOfTheWallThatRuns) {
  const Device device(lhifam_parameters());
  const Simulation below = simulate(device, simulation_of(starting_at(spring_wall(8000.0), {1e-3, 1e-3}), 20.0));
  EXPECT_NEAR(below.linear.critical.stiffness, critical, 1e-6);
  EXPECT_NEAR(*below.linear.wall_share, 8000.0 / critical, 1e-9);
  EXPECT_EQ(below.linear.wall_stable, true);
  EXPECT_EQ(below.linear.agrees, true);
  const Simulation above = simulate(device, simulation_of(starting_at(spring_wall(9800.0), {1e-3, 1e-3}), 20.0));
  EXPECT_EQ(above.linear.wall_stable, false);
  EXPECT_EQ(above.linear.agrees, true);
  const Simulation free = simulate(device, simulation_of(starting_at({}, {0.0, 0.0}, {0.1, 0.1})));
  EXPECT_FALSE(free.linear.wall_stable || free.linear.agrees || free.linear.wall_share);
  EXPECT_THAT(whats(free), Contains(HasSubstr("no wall")));
}

TEST(SimulationLinear, FrictionThatHoldsAnUnstableWallIsNamed) {
  const Simulation result = simulate(Device(test::with_friction(lhifam_parameters(), 0.5, 1.0)),
                                     simulation_of(starting_at(spring_wall(9500.0), {1e-3, 1e-3}), 5.0));
  EXPECT_EQ(result.verdict, LoopVerdict::settles);
  EXPECT_EQ(result.linear.agrees, false);
  EXPECT_THAT(result.nonlinear_parts, ElementsAre(NonlinearPart::coulomb_friction));
}

// Just above the critical stiffness nothing grows within a short run.
TEST(SimulationLinear, AGrowthThatIsHiddenLeavesTheVerdictOpen) {
  for (const double above : {1e-6, 1e-4, 1e-3}) {
    SCOPED_TRACE(above);
    SimulationOptions options = simulation_of(starting_at(spring_wall((1.0 + above) * critical), {1e-3, 1e-3}), 1.7);
    options.user_force = step(1e-3);
    const Simulation result = simulate(Device(lhifam_parameters()), options);
    EXPECT_EQ(result.linear.wall_stable, false);
    EXPECT_NE(result.verdict, LoopVerdict::settles);
    EXPECT_NE(result.verdict, LoopVerdict::forced);
  }
}

TEST(SimulationTrust, IsTheDevices) {
  DeviceParameters device = lhifam_with_wall(5000.0);
  device.uncertainty = Uncertainty{{"link.0.stiffness"}, {{1.0}}, "the stiffness is not determined"};
  const Simulation result = simulate(Device(device));
  EXPECT_EQ(result.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_THAT(result.trust.reasons, Contains(HasSubstr("the stiffness is not determined")));
}

TEST(SimulationStart, LiesBeyondTheStiction) {
  DeviceParameters device = test::with_friction(lhifam_with_wall(5000.0), 4.0, 4.0);  // 5 N pull at 1 mm
  const Simulation result = simulate(Device(device));
  EXPECT_THAT(result.loop.initial_position, ElementsAre(16e-3, 16e-3));  // ten times 8 N
  EXPECT_GT(result.friction_events, 2U);
  EXPECT_THAT(whats(result), Contains(HasSubstr("inside the stiction: 5 N pull there, 8 N hold")));
  device.bodies[1].coulomb = 0.9;  // 4.9 N: 1 mm is enough
  const Simulation moves = simulate(Device(device));
  EXPECT_THAT(moves.loop.initial_position, ElementsAre(1e-3, 1e-3));
  EXPECT_THAT(whats(moves), Not(Contains(HasSubstr("stiction"))));
}

TEST(SimulationStart, LiesBeyondTheEncodersStep) {
  DeviceParameters device = lhifam_with_wall(5000.0);
  device.sensor.resolution = 5e-3;  // 1 mm is measured as 0
  const Simulation result = simulate(Device(device));
  EXPECT_THAT(result.loop.initial_position, ElementsAre(50e-3, 50e-3));
  EXPECT_THAT(whats(result), Contains(HasSubstr("less than the encoder sees")));
}

TEST(SimulationStart, AStartThatWasAskedForStaysAndItsStictionIsSaid) {
  const Device device(test::with_friction(lhifam_with_wall(5000.0), 6.0, 1.0));
  SimulationOptions options;
  options.initial_position = {1e-3, 1e-3};
  const Simulation result = simulate(device, options);
  EXPECT_EQ(result.final_position, 1e-3);
  ASSERT_THAT(whats(result), Contains(HasSubstr("never moves: its friction of 7 N")));
  EXPECT_THAT(result.remarks.back().remedy, HasSubstr("14 mm"));
  // No start helps where the actuator is weaker than the friction.
  DeviceParameters weak = device.parameters();
  weak.actuator.force_limit = 5.0;
  const Simulation stuck = simulate(Device(weak));
  EXPECT_EQ(stuck.final_position, 1e-3);
  EXPECT_THAT(stuck.remarks.back().remedy, HasSubstr("force limit above the friction"));
}

// Under a steady force F a damper alone lets the device drift at v = F/(b + B): the encoder steps v/q times a second,
// each a force of B q/T for one sample.
TEST(QuantisationForce, OfADampedDriftIsThatOfTheCounts) {
  DeviceParameters device = test::rigid_parameters();
  device.wall.damping = 20.0;
  device.sensor.resolution = 1e-4;
  SimulationOptions options;
  options.user_force = step(0.1);
  options.duration = 8.0;
  const Simulation result = simulate(Device(device), options);
  EXPECT_EQ(result.verdict, LoopVerdict::drifts);
  ASSERT_TRUE(result.quantisation_force);
  EXPECT_NEAR(result.quantisation_force->amplitude, 0.5 * 20.0 * 1e-4 / 1e-3, 0.02);
  EXPECT_NEAR(result.quantisation_force->frequency, 2.0 * pi * (0.1 / 23.5) / 1e-4, 0.02 * 2.0 * pi * 42.6);
  EXPECT_TRUE(result.encoder_chatters);
  EXPECT_THAT(whats(result), Contains(HasSubstr("ripple by 1 N either way, at 42.")));
}

// The springs hold a position between two counts: the encoder cannot settle on either.
TEST(QuantisationForce, OfADeviceHeldBetweenTwoCountsIsNamed) {
  DeviceParameters device = lhifam_with_wall(5000.0);
  device.bodies[1].damping = 30.0;
  device.sensor.resolution = 1e-3;
  SimulationOptions options;
  options.user_force = step(2.5);  // half a count
  options.duration = 20.0;
  const Simulation result = simulate(Device(device), options);
  EXPECT_NE(result.verdict, LoopVerdict::unstable);
  ASSERT_TRUE(result.quantisation_force);
  EXPECT_NEAR(result.quantisation_force->amplitude, 2.5, 0.1);  // K q/2
  EXPECT_TRUE(result.encoder_chatters);
  EXPECT_THAT(whats(result), Contains(HasSubstr("the encoder's steps of 1 mm make the force ripple")));
}

// Once the encoder reads one step only, the place within it decays on: that was told as a ripple of the force.
TEST(QuantisationForce, IsNoneWhereTheForceRestsAtLast) {
  DeviceParameters device = lhifam_with_wall(3000.0);
  device.bodies[1].damping = 30.0;
  device.wall.damping = 10.0;
  device.sensor.resolution = 2e-4;
  SimulationOptions options;
  options.duration = 6.0;
  options.keep_every = 1;
  const Simulation result = simulate(Device(device), options);
  const std::vector<double>& commands = result.trajectory.command;
  const auto tail = std::span(commands).last(commands.size() / 10);
  ASSERT_TRUE(std::ranges::all_of(tail, [&](double each) { return each == tail.front(); }));
  EXPECT_FALSE(result.quantisation_force);
}

TEST(SimulationRemarks, SayWhereTheWallCannotAct) {
  DeviceParameters device = lhifam_with_wall(500.0);
  device.sensor.resolution = 1e-3;
  SimulationOptions options;
  options.initial_position = {0.4e-3, 0.4e-3};
  EXPECT_THAT(whats(simulate(Device(device), options)),
              Contains(HasSubstr("reads the same step of 1 mm all the time")));
  DeviceParameters weak = test::with_friction(lhifam_with_wall(5000.0), 0.0, 10.0);
  weak.actuator.force_limit = 3.0;
  EXPECT_THAT(whats(simulate(Device(weak))), Contains(HasSubstr("no wall moves the device")));
}

TEST(QuantisationForce, IsNoneWithoutAnEncoderAndAtRest) {
  EXPECT_FALSE(simulate(Device(lhifam_with_wall(5000.0))).quantisation_force);
  DeviceParameters device = test::with_friction(lhifam_with_wall(5000.0), 0.5, 1.0);
  device.sensor.resolution = 3.14e-6;
  const Simulation rests = simulate(Device(device));
  EXPECT_EQ(rests.verdict, LoopVerdict::settles);
  EXPECT_FALSE(rests.quantisation_force);
  EXPECT_FALSE(rests.encoder_chatters);
}

// A swinging device has a ripple too, but it is not what moves the force.
TEST(QuantisationForce, OfALargeOscillationIsNoChatter) {
  DeviceParameters device = lhifam_with_wall(5000.0);
  device.sensor.resolution = 3.14e-6;
  const Simulation result = simulate(Device(device));
  EXPECT_EQ(result.verdict, LoopVerdict::settles);
  ASSERT_TRUE(result.quantisation_force);
  EXPECT_LT(result.quantisation_force->amplitude, 5000.0 * 3.14e-6);
  EXPECT_FALSE(result.encoder_chatters);
}

// Too few swings to judge: nothing is said about the encoder either.
TEST(QuantisationForce, OfAnUndecidedRunIsNoChatter) {
  DeviceParameters device = lhifam_with_wall(500.0);
  device.sensor.resolution = 3.14e-6;
  SimulationOptions options;
  options.duration = 6.5;
  const Simulation result = simulate(Device(device), options);
  EXPECT_EQ(result.verdict, LoopVerdict::undecided);
  EXPECT_TRUE(result.quantisation_force);
  EXPECT_FALSE(result.encoder_chatters);
}

// Walls of 0.01 to 0.9 times the critical stiffness: slow swings, and a damper with which the device creeps.
TEST(Simulate, RunsUntilTheVerdictIsFirm) {
  for (const double resolution : {0.0, 3.14e-6}) {
    for (const double stiffness : {50.0, 500.0, 2000.0, 8000.0}) {
      for (const double damping : {0.0, 20.0, 200.0}) {
        DeviceParameters device = lhifam_with_wall(stiffness);
        device.wall.damping = damping;
        device.sensor.resolution = resolution;
        const Simulation result = simulate(Device(device));
        if (resolution == 0.0) {
          EXPECT_EQ(result.verdict, LoopVerdict::settles) << stiffness << ", " << damping;
        } else {
          EXPECT_NE(result.verdict, LoopVerdict::undecided) << stiffness << ", " << damping;
          EXPECT_NE(result.verdict, LoopVerdict::drifts) << stiffness << ", " << damping;
        }
      }
    }
  }
}

TEST(SimulationRemarks, SayWhatTheVerdictDoesNot) {
  const Device device(lhifam_parameters());
  HybridLoopOptions loop = starting_at(spring_wall(5000.0), {2e-3, 2e-3});
  loop.controller.contact = ControllerOptions::Contact::unilateral;
  EXPECT_THAT(whats(simulate(device, simulation_of(loop))), Contains(HasSubstr("starts 2 mm inside the wall")));
  loop.initial_position = {-2e-3, -2e-3};
  EXPECT_THAT(whats(simulate(device, simulation_of(loop))), Contains(HasSubstr("never touches the wall")));
  SimulationOptions diverging = simulation_of(starting_at(spring_wall(40000.0), {1e-3, 1e-3}), 10.0);
  diverging.divergence = 0.5;
  const Simulation diverged = simulate(device, diverging);
  EXPECT_TRUE(diverged.diverged);
  EXPECT_THAT(whats(diverged), Contains(HasSubstr("the position passed 500 mm")));
  const Simulation brief = simulate(device, simulation_of(starting_at(spring_wall(5000.0), {1e-3, 1e-3}), 0.3));
  EXPECT_EQ(brief.verdict, LoopVerdict::undecided);
  EXPECT_EQ(brief.remarks.front().remedy, "simulate for longer");
  UserForce recorded;
  recorded.kind = UserForce::Kind::recorded;
  recorded.samples.assign(1000, 1.0);
  recorded.period = 1e-3;
  SimulationOptions pushed = simulation_of(test::pushed_by(spring_wall(5000.0), recorded), 1.0);
  EXPECT_THAT(whats(simulate(device, pushed)), Contains(HasSubstr("in the part of the run that is judged")));
}

TEST(SimulationProblem, NamesTheMember) {
  const Device device(lhifam_with_wall(5000.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto member_of = [&device](auto&& change) {
    SimulationOptions options;
    change(options);
    const auto problem = find_problem(options, device);
    EXPECT_THROW((void)simulate(device, options), Error);
    return problem ? problem->member : "none";
  };
  using Options = SimulationOptions;
  EXPECT_FALSE(find_problem(Options{}, device));
  EXPECT_EQ(member_of([nan](Options& options) { options.duration = nan; }), "duration");
  EXPECT_EQ(member_of([](Options& options) { options.divergence = 0.0; }), "divergence");
  EXPECT_EQ(member_of([nan](Options& options) { options.wall_position = nan; }), "wall_position");
  EXPECT_EQ(member_of([](Options& options) { options.controller = spring_wall(-1.0).controller; }),
            "controller.stiffness");
  EXPECT_EQ(member_of([](Options& options) { options.initial_position = {1.0}; }), "initial_position");
  EXPECT_EQ(member_of([](Options& options) { options.initial_position = {0.0, 0.0}; }), "initial_position");
  EXPECT_EQ(member_of([nan](Options& options) { options.initial_velocity = {nan, 0.0}; }), "initial_velocity");
  EXPECT_EQ(member_of([](Options& options) { options.user_force.kind = UserForce::Kind::sine; }),
            "user_force.frequency");
  EXPECT_EQ(member_of([](Options& options) { options.faults.lost_sample_probability = 1.5; }),
            "faults.lost_sample_probability");
  EXPECT_EQ(member_of([](Options& options) { options.faults.sampling_jitter = 1e-3; }), "faults.sampling_jitter");
  EXPECT_EQ(member_of([](Options& options) { options.faults.overrun_delay = 1e9; }), "faults.overrun_delay");
  EXPECT_EQ(member_of([](Options& options) { options.contact = ControllerOptions::Contact::unilateral; }), "contact");
  const auto nothing = find_problem(Options{}, Device(lhifam_parameters()));
  ASSERT_TRUE(nothing);
  EXPECT_EQ(nothing->member, "");
  EXPECT_THAT(nothing->what, HasSubstr("nothing moves the device"));
}

}  // namespace
}  // namespace zwidth
