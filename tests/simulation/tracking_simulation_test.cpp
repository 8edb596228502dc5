// The loop in time behind a drive that tracks the position: the motion by other states, and what is said of it.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>
#include <vector>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"
#include "zwidth/simulation/simulate.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

DeviceParameters tracked_device(test::RandomDevices& random, std::string_view kind) {
  DeviceParameters parameters = random.device(kind);
  parameters.sensor.tracking_bandwidth = random.log_uniform(300.0, 1e4);
  return parameters;
}

DeviceParameters with_wall_stiffness(DeviceParameters parameters, double stiffness) {
  parameters.wall.stiffness = stiffness;
  return parameters;
}

/// What the drive reads at k T when a spring holds the device that starts at rest 1 mm inside. The tracking in other states than
/// the library's: x1 = y/(s/w + 1), x2 = x1/(s/w + 1), of which 2 x1 - x2 is read.
std::vector<double> own_readings(const DeviceParameters& parameters, double stiffness, int samples) {
  DeviceParameters untracked = parameters;
  untracked.sensor.tracking_bandwidth = 0.0;
  const ContinuousStateSpace device = state_space(Device(untracked));
  const double w = parameters.sensor.tracking_bandwidth;
  const double period = parameters.loop.sampling_period;
  const auto whole = static_cast<std::size_t>(parameters.loop.delay / period);
  const double part = parameters.loop.delay - static_cast<double>(whole) * period;
  const Eigen::Index n = device.A.rows() + 2;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + 1, n + 1);  // the force is the last state
  a.topLeftCorner(n - 2, n - 2) = device.A;
  a.col(n).head(n - 2) = device.B;
  a.row(n - 2).head(n - 2) = w * device.C;
  a(n - 2, n - 2) = a(n - 1, n - 1) = -w;
  a(n - 1, n - 2) = w;
  const Eigen::MatrixXd before = (a * part).exp();
  const Eigen::MatrixXd after = (a * (period - part)).exp();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n + 1);
  x.head(static_cast<Eigen::Index>(parameters.bodies.size())).setConstant(1e-3);
  x(n - 2) = x(n - 1) = 1e-3;
  std::vector<double> forces(whole + 1, 0.0);  // those that are on their way, and the one that acts
  std::vector<double> readings;
  for (int k = 0; k < samples; ++k) {
    readings.push_back(2.0 * x(n - 2) - x(n - 1));
    forces.push_back(-stiffness * readings.back());
    x(n) = forces[static_cast<std::size_t>(k)];
    x = (before * x).eval();
    x(n) = forces[static_cast<std::size_t>(k) + 1];
    x = (after * x).eval();
  }
  return readings;
}

TEST(TrackingSimulation, MovesAsTheSameLoopInOtherStates) {
  constexpr int samples = 400;
  test::RandomDevices random(530);
  int compared = 0;
  for (int i = 0; i < 40 && compared < 20; ++i) {
    const std::string_view kind = test::device_kinds[random.index(19)];
    if (kind == "chain" || kind == "stiff_link") continue;
    DeviceParameters parameters = tracked_device(random, kind);
    parameters.wall = {};
    const CriticalStiffness critical = critical_stiffness(Device(parameters));
    if (critical.status != StiffnessStatus::finite) continue;
    const double stiffness = 0.8 * critical.stiffness;
    HybridLoopOptions options;
    options.controller.kind = ControllerOptions::Kind::wall;
    options.controller.stiffness = stiffness;
    options.controller.contact = ControllerOptions::Contact::bilateral;
    options.initial_position.assign(parameters.bodies.size(), 1e-3);
    HybridLoop loop(Device(parameters), options);
    const std::vector<double> own = own_readings(parameters, stiffness, samples);
    double largest = 0.0;
    for (int k = 0; k < samples; ++k) {
      largest = std::max(largest, std::abs(own[static_cast<std::size_t>(k)]));
      ASSERT_NEAR(loop.sensed_position(), own[static_cast<std::size_t>(k)], 1e-8 * largest)
          << kind << " " << i << " " << k;
      loop.step();
    }
    ++compared;
  }
  EXPECT_EQ(compared, 20);
}

// Long enough for the slowest pole to change the motion by e^20.
TEST(TrackingSimulation, GrowsAboveTheLimitAndSettlesBelow) {
  constexpr double most_samples = 4e5;
  test::RandomDevices random(531);
  int compared = 0;
  for (int i = 0; i < 60 && compared < 20; ++i) {
    const std::string_view kind = test::device_kinds[random.index(19)];
    if (kind == "light_damping" || kind == "chain" || kind == "everything") continue;
    const DeviceParameters parameters = tracked_device(random, kind);
    const CriticalStiffness critical = critical_stiffness(Device(parameters));
    if (critical.status != StiffnessStatus::finite || critical.stable_intervals.size() != 1) continue;
    for (const double share : {0.9, 1.1}) {
      const Device device(with_wall_stiffness(parameters, share * critical.stiffness));
      const double samples = std::max(2000.0, 20.0 / std::abs(std::log(wall_margins(device).spectral_radius)));
      if (samples > most_samples) continue;
      SimulationOptions options;
      options.duration = samples * parameters.loop.sampling_period;
      options.keep_every = 0;
      EXPECT_EQ(simulate(device, options).verdict, share < 1.0 ? LoopVerdict::settles : LoopVerdict::unstable)
          << kind << " " << i;
      ++compared;
    }
  }
  EXPECT_GE(compared, 15);
}

// A slow pole that hardly decays in a second looked like a motion that goes on for ever, on either side of the limit, which it
// cannot in a linear loop: here poles change by 1.3 % and 14 % a second.
TEST(TrackingSimulation, ALinearLoopBesideItsLimitHasNoLimitCycle) {
  DeviceParameters parameters;
  parameters.bodies = {{.name = "motor", .mass = 0.05905334938984760, .damping = 0.01592519393173838},
                       {.name = "handle", .mass = 4.131604641500583, .damping = 0.2074805637958083}};
  parameters.links = {{0, 1, 9681.015674468637, 0.1529250004379799}};
  parameters.loop.held = 1;
  parameters.loop.sampling_period = 1e-3;
  parameters.loop.delay = 5.863165697602124e-4;
  parameters.actuator.time_constant = 6.751996478981962e-5;
  parameters.sensor.tracking_bandwidth = 829.0365363175919;
  const double limit = critical_stiffness(Device(parameters)).stiffness;
  EXPECT_NEAR(limit, 110.2711958, 1e-6);
  const auto verdict_at = [&](double share) {
    return simulate(Device(with_wall_stiffness(parameters, share * limit)), {}).verdict;
  };
  EXPECT_EQ(verdict_at(0.9), LoopVerdict::settles);
  EXPECT_EQ(verdict_at(1.1), LoopVerdict::unstable);
}

TEST(TrackingSimulation, FrictionHoldsWhatWouldGrow) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.sensor.tracking_bandwidth = 1000.0;
  const double limit = critical_stiffness(Device(parameters)).stiffness;
  for (Body& body : parameters.bodies) body.coulomb = 50.0;
  EXPECT_NE(simulate(Device(with_wall_stiffness(parameters, 1.05 * limit)), {}).verdict, LoopVerdict::unstable);
}

}  // namespace
}  // namespace zwidth
