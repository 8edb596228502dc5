// What is published of a rigid device whose spring runs at 20 kHz and its damper at 2 kHz: Koul, Saha & Manivannan 2016 and
// 2018, Mashayekhi et al. 2026. The parameters are ours: those of LHIfAM with a rigid cable.

#include <gtest/gtest.h>

#include <cmath>

#include "lhifam.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/critical_damping.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double fast_period = 5e-5;
constexpr double slow_period = 5e-4;

Device rigid_of_rates(double spring_period, double damper_period, double damping) {
  DeviceParameters parameters = test::rigid_parameters();
  parameters.loop.sampling_period = spring_period;
  parameters.loop.damper = LoopDamper{damper_period, 0.0};
  parameters.wall.damping = damping;
  return Device(parameters);
}

double stiffest(double spring_period, double damper_period, double damping) {
  return critical_stiffness(rigid_of_rates(spring_period, damper_period, damping)).stiffness;
}

/// docs/theory.md, "Critical stiffness".
double closed_form(double period) {
  const auto& body = test::rigid_parameters().bodies[0];
  const double decay = std::exp(-body.damping * period / body.mass);
  const double rest = -std::expm1(-body.damping * period / body.mass);
  return body.damping * body.damping * rest / (body.mass * rest - decay * body.damping * period);
}

TEST(PublishedTwoRates, WithoutADamperTheSpringsRateDecidesAlone) {
  EXPECT_EQ(stiffest(fast_period, slow_period, 0.0), stiffest(fast_period, fast_period, 0.0));
  EXPECT_NEAR(stiffest(fast_period, slow_period, 0.0), closed_form(fast_period), 1e-6 * closed_form(fast_period));
  EXPECT_NEAR(stiffest(fast_period, slow_period, 0.0) / stiffest(slow_period, slow_period, 0.0), 10.0, 1e-3);
}

TEST(PublishedTwoRates, TheDampersRateDecidesTheLargestDamperAlone) {
  const double together = critical_damping(rigid_of_rates(slow_period, slow_period, 1.0)).damping;
  EXPECT_NEAR(critical_damping(rigid_of_rates(fast_period, slow_period, 1.0)).damping, together, 1e-9 * together);
  EXPECT_NEAR(together, 2.0 * 5.4 / slow_period, 1e-3 * together);
}

// So the range of stable B at any K is wider than that of both at 2 kHz, and narrower than that of both at 20 kHz.
TEST(PublishedTwoRates, EveryDamperBearsAStifferSpring) {
  for (double damping = 500.0; damping < 21600.0; damping += 500.0) {
    SCOPED_TRACE(damping);
    const double of_two_rates = stiffest(fast_period, slow_period, damping);
    EXPECT_GT(of_two_rates, stiffest(slow_period, slow_period, damping));
    EXPECT_LT(of_two_rates, stiffest(fast_period, fast_period, damping));
  }
}

// Bisection on the eigenvalues of the loop over 0.5 ms, in 40 digits, by another program.
TEST(PublishedTwoRates, StiffnessesOfAnotherProgram) {
  EXPECT_NEAR(stiffest(fast_period, slow_period, 2000.0), 26635446.3732359, 1e-3);
  EXPECT_NEAR(stiffest(fast_period, slow_period, 10000.0), 24098464.9485102, 1e-3);
  EXPECT_NEAR(stiffest(fast_period, slow_period, 20000.0), 3564758.83865569, 1e-3);
}

}  // namespace
}  // namespace zwidth
