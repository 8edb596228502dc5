// Random devices, frictions, walls, starts and forces against the independent integration.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "property/random_devices.hpp"
#include "simulation/reference_loop.hpp"

namespace zwidth {
namespace {

constexpr double relative_tolerance = 1e-9;  // of the largest value of each position and velocity
// Each stick-slip instant of a light body can amplify what was before: how much is shown by a second run of the
// reference, whose start differs by this.
constexpr double perturbation = 1e-13;  // relative
constexpr int samples = 150;

struct Trial {
  DeviceParameters device;
  HybridLoopOptions options;
};

Trial random_trial(test::RandomDevices& random) {
  Trial trial;
  do {
    trial.device = random.device(test::device_kinds[random.index(test::device_kinds.size() - 1)]);
  } while (trial.device.bodies.size() > 4);
  DeviceParameters& device = trial.device;
  HybridLoopOptions& options = trial.options;
  const double period = device.loop.sampling_period;
  double mass = 0.0;
  for (const Body& body : device.bodies) mass += body.mass;
  const double speed = 0.1;                                         // m/s
  const double wall_rate = random.log_uniform(0.01, 0.3) / period;  // rad/s, of the mass on the wall
  const double stiffness = mass * wall_rate * wall_rate;
  const double force = mass * speed * wall_rate;  // what stops it
  for (Body& body : device.bodies) {
    if (random.chance(0.7)) body.coulomb = force * random.log_uniform(1e-3, 0.5);
    options.initial_position.push_back(speed / wall_rate * random.uniform(-1.0, 1.0));
    options.initial_velocity.push_back(random.chance(0.3) ? 0.0 : speed * random.uniform(-1.0, 1.0));
  }
  options.controller.kind = ControllerOptions::Kind::wall;
  options.controller.stiffness = stiffness;
  options.controller.damping = random.chance(0.5) ? 0.0 : 0.1 * stiffness / wall_rate;
  options.controller.velocity_filter_hz = random.chance(0.5) ? 0.0 : 0.05 / period;
  if (random.chance(0.3)) options.controller.contact = ControllerOptions::Contact::unilateral;
  if (random.chance(0.3)) options.controller.position = speed / wall_rate * random.uniform(-1.0, 1.0);
  if (random.chance(0.3)) device.actuator.force_limit = force;
  UserForce& user = options.user_force;
  user.amplitude = force * random.uniform(-1.0, 1.0);
  user.start = random.uniform(0.0, 30.0) * period;
  switch (random.index(5)) {
    case 0:
      user.kind = UserForce::Kind::step;
      break;
    case 1:
      user.kind = UserForce::Kind::ramp;
      user.amplitude *= 0.02 / period;
      break;
    case 2:
      user.kind = UserForce::Kind::sine;
      user.frequency = random.log_uniform(0.01, 1.0) / period;
      break;
    case 3:
      user.kind = UserForce::Kind::recorded;
      user.period = random.log_uniform(0.2, 5.0) * period;
      for (int k = 0; k < 60; ++k) user.samples.push_back(force * random.uniform(-1.0, 1.0));
      break;
    default:
      user = {};
  }
  return trial;
}

TEST(HybridLoopProperty, RandomLoopsMoveAsAnIndependentIntegrationSays) {
  const char* asked = std::getenv("ZWIDTH_SIMULATION_TRIALS");
  const int trials = asked ? std::atoi(asked) : 8;
  std::size_t events = 0;
  for (int k = 0; k < trials; ++k) {
    SCOPED_TRACE("trial " + std::to_string(k));
    test::RandomDevices random(static_cast<std::uint64_t>(k) + 1);
    const Trial trial = random_trial(random);
    SCOPED_TRACE(trial.device.name);
    HybridLoop ours(Device(trial.device), trial.options);
    test::ReferenceLoop reference(trial.device, trial.options);
    HybridLoopOptions perturbed_options = trial.options;
    for (double& each : perturbed_options.initial_position) each *= 1.0 + perturbation;
    test::ReferenceLoop perturbed(trial.device, perturbed_options);
    const std::size_t bodies = trial.device.bodies.size();
    std::vector<double> sensitivity(2 * bodies, 0.0);
    std::vector<double> largest(2 * bodies, 0.0);
    std::vector<double> worst(2 * bodies, 0.0);
    for (int sample = 0; sample < samples; ++sample) {
      ours.step();
      reference.step();
      perturbed.step();
      for (std::size_t i = 0; i < bodies; ++i) {
        largest[i] = std::max(largest[i], std::abs(reference.position(i)));
        worst[i] = std::max(worst[i], std::abs(ours.position(i) - reference.position(i)));
        sensitivity[i] = std::max(sensitivity[i], std::abs(perturbed.position(i) - reference.position(i)));
        sensitivity[bodies + i] =
            std::max(sensitivity[bodies + i], std::abs(perturbed.velocity(i) - reference.velocity(i)));
        largest[bodies + i] = std::max(largest[bodies + i], std::abs(reference.velocity(i)));
        worst[bodies + i] = std::max(worst[bodies + i], std::abs(ours.velocity(i) - reference.velocity(i)));
      }
    }
    for (std::size_t i = 0; i < worst.size(); ++i) {
      EXPECT_LE(worst[i], relative_tolerance * largest[i] + sensitivity[i]) << "state " << i;
    }
    EXPECT_EQ(ours.overloaded_steps(), 0U);
    events += reference.events();
  }
  EXPECT_GT(events, static_cast<std::size_t>(trials));
}

}  // namespace
}  // namespace zwidth
