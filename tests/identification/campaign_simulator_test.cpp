// The simulator of the campaign's records, against motions that are known otherwise.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "identification/campaign/simulator.hpp"
#include "identification/friction_body.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::test {
namespace {

constexpr double simulated_period = 1e-3;

std::vector<double> random_commands(std::size_t count) {
  std::mt19937_64 random(3);
  std::vector<double> commands;
  for (std::size_t k = 0; k < count; ++k) commands.push_back(static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0);
  return commands;
}

std::vector<double> played(const simulated::Plant& plant, const std::vector<double>& commands) {
  simulated::Motion motion(plant, simulated_period);
  std::vector<double> positions;
  for (const double command : commands) {
    positions.push_back(motion.position(plant.sensed));
    motion.command(command);
    motion.advance(simulated_period);
  }
  return positions;
}

simulated::Plant driven_pair() {
  simulated::Plant plant;
  plant.masses = {{.mass = 0.3, .damping = 0.4}, {.mass = 0.2, .damping = 0.3, .stiffness = 40.0}};
  plant.joints = {{.first = 0, .second = 1, .stiffness = 2e4, .damping = 0.8}};
  return plant;
}

void expect_equal_motion(const std::vector<double>& found, const std::vector<double>& exact, double share) {
  double largest = 0.0;
  for (const double each : exact) largest = std::max(largest, std::abs(each));
  ASSERT_EQ(found.size(), exact.size());
  for (std::size_t k = 0; k < found.size(); ++k) ASSERT_NEAR(found[k], exact[k], share * largest) << "sample " << k;
}

TEST(CampaignSimulator, LinearMotionOfTwoBodiesIsTheExactDiscreteOne) {
  for (const double delay : {0.0, 0.4e-3, 2.7e-3}) {
    for (const double lag : {0.0, 0.6e-3}) {
      for (const std::size_t sensed : {0U, 1U}) {
        simulated::Plant plant = driven_pair();
        plant.drive.delay = delay;
        plant.drive.lag = lag;
        plant.sensed = sensed;
        DeviceParameters device;
        device.name = "two bodies";
        device.bodies = {{"motor", 0.3, 0.4, 0.0, 0.0}, {"handle", 0.2, 0.3, 40.0, 0.0}};
        device.links = {{0, 1, 2e4, 0.8}};
        device.loop = {0, sensed, 1, simulated_period, delay};
        device.actuator.time_constant = lag;
        const std::vector<double> commands = random_commands(4000);
        const auto exact = forced_response(sample(state_space(Device(device)), {simulated_period, delay}), commands);
        expect_equal_motion(played(plant, commands), exact, 1e-6);
      }
    }
  }
}

TEST(CampaignSimulator, ARubbingBodyMovesAsInClosedForm) {
  simulated::Plant plant;
  plant.masses = {{.mass = 0.2, .damping = 0.5, .friction = {.coulomb = 0.3}}};
  FrictionBody body{.mass = 0.2, .viscous = 0.5, .coulomb = 0.3};
  const std::vector<double> commands = random_commands(4000);
  std::vector<double> exact;
  for (const double command : commands) {
    exact.push_back(body.position);
    body.move(command, simulated_period);
  }
  expect_equal_motion(played(plant, commands), exact, 1e-6);
}

TEST(CampaignSimulator, AStickingBodyDoesNotCreep) {
  simulated::Plant plant = driven_pair();
  plant.masses[0].friction.coulomb = 0.5;
  simulated::Motion motion(plant, simulated_period);
  for (int k = 0; k < 5000; ++k) {
    motion.command(0.499 * std::sin(0.1 * k));
    motion.advance(simulated_period);
    ASSERT_EQ(motion.position(0), 0.0);
    ASSERT_TRUE(motion.sticks(0));
  }
  motion.command(0.501);
  motion.advance(simulated_period);
  EXPECT_GT(motion.position(0), 0.0);
  EXPECT_FALSE(motion.sticks(0));
}

TEST(CampaignSimulator, StictionHoldsUntilItIsExceeded) {
  simulated::Plant plant;
  plant.masses = {{.mass = 0.1, .friction = {.coulomb = 0.2, .stiction = 0.4, .stribeck_speed = 0.01}}};
  simulated::Motion motion(plant, simulated_period);
  motion.command(0.39);
  motion.advance(1.0);
  EXPECT_EQ(motion.position(0), 0.0);
  motion.command(0.41);
  motion.advance(1.0);
  // Once it slides fast, 0.21 N are left of the 0.41 N: 2.1 m/s within a second.
  EXPECT_NEAR(motion.velocity(0), 2.1, 0.1);
}

/// With nothing that drives it a motion loses energy, whatever rubs, slips or has play.
TEST(CampaignSimulator, EnergyDoesNotGrow) {
  std::vector<simulated::Plant> plants(7, driven_pair());
  plants[1].masses[0].friction.coulomb = 0.3;
  plants[2].masses[1].friction = {.coulomb = 0.2, .stiction = 0.3, .stribeck_speed = 0.02, .asymmetry = 0.3};
  plants[3].masses[0].friction = {.coulomb = 0.3, .bristles = 3e3};
  plants[4].masses[0].friction.quadratic = 2.0;
  plants[4].masses[1].cubic = 1e6;
  plants[5].joints[0].gap = 1e-3;
  plants[6].joints[0].relaxing_stiffness = 5e3;
  plants[6].joints[0].relaxing_damping = 30.0;
  plants[6].joints[0].friction = 0.2;
  plants[6].joints[0].bristles = 4e3;
  for (const simulated::Plant& plant : plants) {
    simulated::Motion motion(plant, simulated_period);
    motion.place(0, 0.01, 0.2);
    motion.place(1, 0.01, -0.1);
    motion.command(0.0);
    const double first = motion.energy();
    double before = first;
    for (int k = 0; k < 20000; ++k) {
      motion.advance(0.1 * simulated_period);
      const double now = motion.energy();
      ASSERT_LE(now, before + 1e-8 * first);
      before = now;
    }
    EXPECT_LT(before, 0.8 * first);
  }
}

TEST(CampaignSimulator, BristlesGiveTheirFrictionHoweverFastTheyBend) {
  simulated::Plant plant;
  plant.masses = {{.mass = 0.5, .friction = {.coulomb = 0.3, .bristles = 3e3}}};
  simulated::Motion motion(plant, simulated_period);
  motion.place(0, 0.0, 2.0);
  motion.command(0.0);
  motion.advance(1.0);
  EXPECT_NEAR(motion.velocity(0), 2.0 - 0.3 / 0.5, 1e-3);
  motion.advance(9.0);  // it comes to rest, and swings on bristles that do not slip
  EXPECT_NEAR(motion.velocity(0), 0.0, 2e-3);
  EXPECT_NEAR(motion.position(0), 0.5 * 2.0 * 2.0 * 0.5 / 0.3, 1e-3);
}

TEST(CampaignSimulator, AVoltageDrivesBackEmfIsADampingBehindItsLag) {
  simulated::Plant plant;
  plant.masses = {{.mass = 0.1, .damping = 0.1}};
  plant.drive.lag = 1e-4;
  plant.drive.back_emf = 0.9;
  simulated::Motion motion(plant, simulated_period);
  motion.command(2.0);
  motion.advance(3.0);
  EXPECT_NEAR(motion.velocity(0), 2.0, 1e-6);  // 2 N over 0.1 and 0.9 N s/m
}

}  // namespace
}  // namespace zwidth::test
