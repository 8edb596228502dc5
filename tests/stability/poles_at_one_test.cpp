// Poles at z = 1 that the wall does not see, and poles next to it: neither decides whether the loop is stable.

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "exact_closed_loop.hpp"
#include "lhifam.hpp"
#include "stability/second_route/pole_count.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

// The limit is finite, sure, and within 1e-6 where a hundred digits find it.
void expect_sure_limit(const DeviceParameters& parameters) {
  const Device device(parameters);
  const CriticalStiffness result = critical_stiffness(device);
  EXPECT_TRUE(result.trust.sound());
  ASSERT_EQ(result.status, StiffnessStatus::finite);
  for (const double below : {1e-6, 0.5, 1.0 - 1e-6}) {
    EXPECT_EQ(internal::unstable_poles_in_digits(device, below * result.stiffness), 0) << below;
  }
  EXPECT_EQ(internal::unstable_poles_in_digits(device, (1.0 + 1e-6) * result.stiffness), 2);
}

int integrators(const DeviceParameters& parameters) {
  int sum = 0;
  for (const SampledTerm& term : sampled_plant(Device(parameters)).terms) sum += term.integrators;
  return sum;
}

DeviceParameters two_bodies(Body motor, Body handle, Link link) {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies = {motor, handle};
  device.links = {link};
  device.loop.sensed = device.loop.actuated = 0;
  device.loop.held = 0;
  return device;
}

// The motor on a spring to ground, the handle held to it by a damper alone: the handle rests anywhere.
TEST(PolesAtOne, BodyWithoutAPlaceOfItsOwn) {
  DeviceParameters device = two_bodies({"motor", 0.112247, 0.124101, 79.7557, 0.0},
                                       {"handle", 0.0482144, 7.81128, 0.0, 0.0}, {0, 1, 0.0, 0.179847});
  for (const double mass : {0.0, 1.3725, 8.62249, 67.1453}) {
    device.user.mass = mass;
    EXPECT_EQ(integrators(device), 0);
    expect_sure_limit(device);
  }
}

// Both free, joined by a damper alone and each damped to ground: two poles at s = 0, one of them seen.
TEST(PolesAtOne, OneOfTwoIsSeen) {
  DeviceParameters device =
      two_bodies({"motor", 0.0183, 0.0576, 0.0, 0.0}, {"handle", 2.356, 0.112, 0.0, 0.0}, {0, 1, 0.0, 7.97});
  EXPECT_EQ(integrators(device), 1);
  expect_sure_limit(device);
  device.bodies[0].damping = device.bodies[1].damping = 0.0;  // now nothing holds them: m s² is seen, one pole is not
  EXPECT_EQ(integrators(device), 2);
}

// A held body joined to neither ground nor the sensed one by a spring, dampers through a grounded body alone.
TEST(PolesAtOne, NoneIsSeenThroughAGroundedBody) {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies = {{"motor", 0.3, 0.0, 0.0, 0.0}, {"frame", 1.0, 0.5, 500.0, 0.0}, {"handle", 0.2, 0.0, 0.0, 0.0}};
  device.links = {{0, 1, 0.0, 2.0}, {1, 2, 0.0, 3.0}};
  device.loop.actuated = device.loop.sensed = 0;
  device.loop.held = 2;
  EXPECT_EQ(integrators(device), 1);
  device.loop.sensed = 2;
  EXPECT_EQ(integrators(device), 0);
}

// Five bodies joined by dampers alone, four of their five places unseen: a hundred digits left the fourfold pole at z = 1
// on the wrong side, and the answer was refused. mpmath with 60 digits.
TEST(PolesAtOne, FiveBodiesJoinedByDampersAlone) {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies = {{"b0", 2, 0.08, 0, 0},
                   {"b1", 0.4, 0.009, 0, 0},
                   {"b2", 0.2, 0, 0, 0},
                   {"b3", 0.2, 0.003, 0, 0},
                   {"b4", 3, 0.04, 0, 0}};
  device.links = {{0, 1, 0, 0.2}, {0, 2, 0, 400}, {1, 3, 0, 0.02}, {0, 4, 0, 0.06}};
  device.loop.actuated = device.loop.sensed = device.loop.held = 1;
  device.loop.sampling_period = 2e-4;
  device.loop.delay = 0.0;
  const CriticalStiffness result = critical_stiffness(Device(device));
  EXPECT_TRUE(result.trust.sound());
  EXPECT_NEAR(result.stiffness / 2290.0301350118534297, 1.0, 1e-12);
  EXPECT_NEAR(result.limit->frequency / 75.6624502646887211, 1.0, 1e-12);
}

// Trees of bodies joined by dampers alone, and some by springs.
TEST(PolesAtOne, TreesOfDampersAreAnswered) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937_64 random(seed);
    const auto log_uniform = [&](double least, double most) {
      return std::exp(std::uniform_real_distribution(std::log(least), std::log(most))(random));
    };
    DeviceParameters parameters = test::lhifam_parameters();
    parameters.bodies.clear();
    parameters.links.clear();
    const std::size_t count = 3 + random() % 4;
    for (std::size_t i = 0; i < count; ++i) {
      parameters.bodies.push_back({"b" + std::to_string(i), log_uniform(0.05, 3.0),
                                   random() % 3 == 0 ? 0.0 : log_uniform(1e-3, 0.1), 0.0, 0.0});
      if (i == 0) continue;
      const bool by_spring = random() % 8 == 0;
      parameters.links.push_back(
          {random() % i, i, by_spring ? log_uniform(100.0, 1e5) : 0.0, log_uniform(1e-2, 400.0)});
    }
    parameters.bodies[0].damping = 0.05;
    parameters.loop.actuated = parameters.loop.sensed = parameters.loop.held = random() % count;
    parameters.loop.sampling_period = 2e-4 * static_cast<double>(1 + random() % 5);
    parameters.loop.delay = 0.0;
    const Device device(parameters);
    const CriticalStiffness result = critical_stiffness(device);
    EXPECT_TRUE(result.trust.sound()) << "seed " << seed;
    ASSERT_EQ(result.status, StiffnessStatus::finite) << "seed " << seed;
    const test::ExactClosedLoop loop(device);
    for (const double share : {1e-3, 0.5, 1.0 - 1e-9}) {
      EXPECT_EQ(loop.poles_outside(share * result.stiffness), 0) << "seed " << seed << " x " << share;
    }
    EXPECT_GT(loop.poles_outside((1.0 + 1e-9) * result.stiffness), 0) << "seed " << seed;
  }
}

// A user of 70 000 t: the pole next to z = 1 is slower than 1e-9 rad per sample, and the damper's integrator with it.
TEST(PolesAtOne, VeryHeavyUserOfADampedWall) {
  DeviceParameters device = two_bodies({"motor", 0.0216215, 0.0393388, 0.0, 0.0},
                                       {"handle", 2.18153, 0.0123903, 0.0, 0.0}, {0, 1, 474.366, 0.501788});
  device.loop.delay = 0.0;
  device.loop.sampling_period = 1e-3;
  device.loop.held = 0;
  device.actuator.time_constant = 14.813;
  device.wall.damping = 38.0352;
  device.wall.velocity_filter_hz = 64.3886;
  for (const double mass : {817227.0, 6.98965e7}) {
    device.user.mass = mass;
    expect_sure_limit(device);
  }
}

}  // namespace
}  // namespace zwidth
