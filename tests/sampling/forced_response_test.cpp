#include "zwidth/sampling/forced_response.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <random>

#include "lhifam.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth {
namespace {

DiscreteStateSpace sampled(const DeviceParameters& parameters) {
  const Device device(parameters);
  return sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
}

TEST(ForcedResponse, AConstantForceAcceleratesARigidBodyAsTheClosedFormSays) {
  // x(t) = F/b (t - m/b (1 - e^{-bt/m})), the force arriving 2.3 samples late.
  const DeviceParameters parameters = test::with_delay(test::rigid_parameters(), 2.3e-3);
  const Body& body = parameters.bodies[0];
  const std::vector<double> positions = forced_response(sampled(parameters), std::vector<double>(5000, 2.0));
  for (std::size_t k = 0; k < positions.size(); ++k) {
    const double t = std::max(0.0, 1e-3 * static_cast<double>(k) - parameters.loop.delay);
    const double exact =
        2.0 / body.damping * (t + body.mass / body.damping * std::expm1(-body.damping / body.mass * t));
    EXPECT_NEAR(positions[k], exact, 1e-10 * exact + 1e-15) << k;
  }
}

TEST(ForcedResponse, DelayedForcesActAsDelayStatesDo) {
  std::mt19937_64 generator(11);
  std::normal_distribution<double> normal;
  std::vector<double> force(400);
  for (double& each : force) each = normal(generator);
  for (const double delay : {0.0, 0.4e-3, 1e-3, 3e-3, 7.25e-3}) {
    const DiscreteStateSpace system = sampled(test::with_delay(test::lhifam_parameters(), delay));
    const DiscreteStateSpace full = with_delay_states(system);
    Eigen::VectorXd state = Eigen::VectorXd::Zero(full.Phi.rows());
    const std::vector<double> positions = forced_response(system, force);
    for (std::size_t k = 0; k < force.size(); ++k) {
      EXPECT_NEAR(positions[k], full.C.dot(state), 1e-15) << "delay " << delay << ", sample " << k;
      state += (full.Phi * state + full.Gamma1 * force[k]).eval();
    }
  }
}

TEST(ForcedResponse, SettlesToTheFrequencyResponse) {
  DeviceParameters parameters = test::with_delay(test::lhifam_parameters(), 0.6e-3);
  parameters.bodies[1].stiffness = 1e5;  // tied to ground, so that the transient dies out
  parameters.bodies[1].damping = 300.0;
  const double frequency = 2.0 * std::numbers::pi * 50.0;  // 20 samples per period
  std::vector<double> force(20000);
  for (std::size_t k = 0; k < force.size(); ++k) force[k] = std::cos(frequency * 1e-3 * static_cast<double>(k));
  const std::vector<double> positions = forced_response(sampled(parameters), force);
  std::complex<double> last_period;
  for (std::size_t k = force.size() - 20; k < force.size(); ++k) {
    last_period += 0.1 * positions[k] * std::polar(1.0, -frequency * 1e-3 * static_cast<double>(k));
  }
  const std::complex<double> expected = response(sampled_plant(Device(parameters)), frequency);
  EXPECT_LT(std::abs(last_period - expected), 1e-9 * std::abs(expected));
}

}  // namespace
}  // namespace zwidth
