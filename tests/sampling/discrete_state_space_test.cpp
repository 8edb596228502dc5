#include "zwidth/sampling/discrete_state_space.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "fifty_digits.hpp"
#include "lhifam.hpp"
#include "log_spaced.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

DiscreteStateSpace sampled(const DeviceParameters& parameters) {
  const Device device(parameters);
  return sample(state_space(device), {device.loop().sampling_period, device.loop().delay});
}

TEST(DiscreteStateSpace, OfAMassIsTheTextbookOne) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies[0] = {"mass", 2.0, 0.0, 0.0, 0.0};
  device.loop.sampling_period = 0.1;
  device.loop.delay = 0.13;
  const DiscreteStateSpace system = sampled(device);  // l = 1, f T = 0.03
  EXPECT_EQ(system.delay_samples, 1U);
  EXPECT_NEAR(system.Phi(0, 1), 0.1, 1e-16);
  EXPECT_EQ(system.Phi(0, 0), 0.0);
  EXPECT_EQ(system.Phi(1, 0), 0.0);
  EXPECT_EQ(system.Phi(1, 1), 0.0);
  EXPECT_NEAR(system.Gamma1(0), 0.07 * 0.07 / 4.0, 1e-17);
  EXPECT_NEAR(system.Gamma1(1), 0.035, 1e-16);
  EXPECT_NEAR(system.Gamma2(0), (0.01 - 0.0049) / 4.0, 1e-17);
  EXPECT_NEAR(system.Gamma2(1), 0.015, 1e-16);
}

// The two routes, and the exact one: modal terms in closed form, matrix exponential. What e^{AT} loses to its norm
// bounds the agreement.
TEST(DiscreteStateSpace, AgreesWithTheModalRouteAndFiftyDigits) {
  for (const double period : {1e-4, 1e-3, 1e-2}) {
    for (const double delay_samples : {0.0, 0.37, 2.0, 3.5}) {
      DeviceParameters parameters = test::lhifam_parameters();
      parameters.loop.sampling_period = period;
      parameters.loop.delay = delay_samples * period;
      const Device device(parameters);
      const DiscreteStateSpace system = sampled(parameters);
      const SampledPlant plant = sampled_plant(device);
      const test::ExactSampledDevice exact(test::exact_state_space(device), {period, parameters.loop.delay});
      for (const double frequency : test::log_spaced(0.1, 0.99 * std::numbers::pi / period, 15)) {
        const std::complex<double> ours = response(system, frequency);
        EXPECT_LE(std::abs(ours / response(plant, frequency) - 1.0), 1e-9) << "T " << period << ", w " << frequency;
        EXPECT_LE(test::relative_error(ours, exact.response(frequency)), 1e-9) << "T " << period << ", w " << frequency;
      }
    }
  }
}

TEST(DiscreteStateSpace, OfATransferFunctionAgreesWithTheModalRoute) {
  for (const double delay : {0.0, 0.4, 1.0}) {
    const Device device(test::transfer_function_parameters({1.0, 3.0}, {1.0, 2.0, 10.0, 4.0, 0.0}, 0.5, delay));
    const DiscreteStateSpace system = sampled(device.parameters());
    const SampledPlant plant = sampled_plant(device);
    for (const double frequency : test::log_spaced(0.01, 6.28, 20)) {
      EXPECT_LE(std::abs(response(system, frequency) / response(plant, frequency) - 1.0), 1e-11);
    }
  }
}

TEST(DiscreteStateSpace, DelayStatesKeepTheResponse) {
  for (const double samples : {0.0, 0.25, 1.0, 1.5, 4.0, 6.75}) {
    const DiscreteStateSpace system = sampled(test::with_delay(test::lhifam_parameters(), samples * 1e-3));
    const DiscreteStateSpace full = with_delay_states(system);
    const bool fractional = samples != std::floor(samples);
    EXPECT_EQ(full.delay_samples, 0U);
    EXPECT_EQ(full.Phi.rows(), 4 + static_cast<Eigen::Index>(std::floor(samples)) + (fractional ? 1 : 0));
    EXPECT_EQ(full.Phi.cols(), full.Phi.rows());
    EXPECT_EQ(full.Gamma1.size(), full.Phi.rows());
    EXPECT_EQ(full.C.size(), full.Phi.rows());
    EXPECT_TRUE(full.Gamma2.isZero(0.0));
    for (const double frequency : test::log_spaced(1.0, 3141.0, 20)) {
      EXPECT_LE(std::abs(response(full, frequency) / response(system, frequency) - 1.0), 1e-9)
          << samples << " samples, " << frequency << " rad/s";
    }
  }
}

TEST(DiscreteStateSpace, BadSamplingThrows) {
  const ContinuousStateSpace system = state_space(Device(test::rigid_parameters()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Sampling sampling : {Sampling{0.0, 0.0}, Sampling{nan, 0.0}, Sampling{1e-3, -1.0}, Sampling{1e-3, nan}}) {
    try {
      (void)sample(system, sampling);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
    }
  }
}

}  // namespace
}  // namespace zwidth
