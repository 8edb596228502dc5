#include "sampling/inner_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include "../lhifam.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"

namespace zwidth::internal {
namespace {

constexpr double fast_period = 1e-4;

// v of 1 N s/m at z = e^{jwT}.
std::complex<double> velocity(const InnerLoop& inner, double frequency) {
  const double period = inner.sampling.period;
  const double a =
      inner.velocity_filter_hz > 0.0 ? std::exp(-2.0 * std::numbers::pi * inner.velocity_filter_hz * period) : 0.0;
  const std::complex<double> late = std::polar(1.0, -frequency * period);
  return (1.0 - a) * (1.0 - late) / (1.0 - a * late) / period;
}

// The sum over the aliases of the slow rate within the fast band, by the matrix exponential:
//     1/N sum_k h(z_k) P_cl(z_k),   z_k = e^{j (w T + 2 pi k)/N},   h = (1 - z^-N)/(1 - z^-1)
std::complex<double> expected_response(const Device& device, const Sampling& outer, const InnerLoop& inner,
                                       double frequency) {
  const ContinuousStateSpace continuous = state_space(device);
  const DiscreteStateSpace to_inner = sample(continuous, inner.sampling);
  const DiscreteStateSpace to_outer = sample(continuous, {inner.sampling.period, outer.delay});
  const auto steps = static_cast<int>(std::lround(outer.period / inner.sampling.period));
  std::complex<double> sum = 0.0;
  for (int k = 0; k < steps; ++k) {
    double alias = frequency + 2.0 * std::numbers::pi * k / outer.period;
    const double nyquist = std::numbers::pi / inner.sampling.period;
    if (alias > nyquist) alias -= 2.0 * nyquist;  // the same point of the circle; a response's conjugate below 0
    const double positive = std::abs(alias);
    const std::complex<double> controller = inner.stiffness + inner.damping * velocity(inner, positive);
    std::complex<double> closed = response(to_outer, positive) / (1.0 + controller * response(to_inner, positive));
    if (alias < 0.0) closed = std::conj(closed);
    const std::complex<double> z = std::polar(1.0, alias * inner.sampling.period);
    sum += (1.0 - std::pow(z, -steps)) / (1.0 - 1.0 / z) * closed;
  }
  return sum / static_cast<double>(steps);
}

void expect_response(const Device& device, const Sampling& outer, const InnerLoop& inner) {
  const SampledPlant plant = sample_behind(modal_form(device), outer, inner);
  for (const double frequency : {3.0, 40.0, 411.0, 1500.0, 3000.0}) {
    const std::complex<double> expected = expected_response(device, outer, inner, frequency);
    EXPECT_LT(std::abs(response(plant, frequency) - expected), 1e-9 * std::abs(expected)) << frequency;
  }
}

TEST(InnerLoop, TheSpringSeesTheAliasesOfTheClosedDamper) {
  const Device device(test::lhifam_parameters());
  for (const double filter : {0.0, 60.0}) {
    for (const double delay : {0.0, 1e-4, 1.3e-4}) {
      for (const double late : {0.0, 1e-3, 2.34e-3}) {
        SCOPED_TRACE(testing::Message() << filter << " Hz, " << delay << " s, " << late << " s");
        expect_response(device, {1e-3, late}, {{fast_period, delay}, 50.0, filter});
      }
    }
  }
}

TEST(InnerLoop, TheDamperSeesTheAliasesOfTheClosedSpring) {
  const Device device(test::lhifam_parameters());
  for (const double delay : {0.0, 3.3e-4}) {
    InnerLoop spring{{fast_period, delay}};
    spring.stiffness = 5000.0;
    expect_response(device, {1e-3, 0.7e-3}, spring);
  }
}

TEST(InnerLoop, OfOneStepIsTheFeedbackOfOneRate) {
  const Device device(test::lhifam_parameters());
  const SampledPlant alone = sampled_plant(device);
  const InnerLoop damper{{1e-3, 0.0}, 50.0};
  const SampledPlant behind = sample_behind(modal_form(device), {1e-3, 0.0}, damper);
  for (const double frequency : {3.0, 40.0, 411.0, 1500.0, 3000.0}) {
    const std::complex<double> open = response(alone, frequency);
    const std::complex<double> expected = open / (1.0 + 50.0 * velocity(damper, frequency) * open);
    EXPECT_LT(std::abs(response(behind, frequency) - expected), 1e-9 * std::abs(expected));
  }
}

TEST(InnerLoop, CountsThePolesThatTheDamperDrivesOut) {
  const Device device(test::lhifam_parameters());
  const auto outside = [&](double damping) {
    int count = 0;
    for (const SampledTerm& term :
         sample_behind(modal_form(device), {1e-3, 0.0}, {{fast_period, 0.0}, damping}).terms) {
      count += term.unstable_poles;
    }
    return count;
  };
  EXPECT_EQ(outside(100.0), 0);
  EXPECT_GT(outside(1e5), 0);
}

}  // namespace
}  // namespace zwidth::internal
