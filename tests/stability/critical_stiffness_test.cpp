#include "zwidth/stability/critical_stiffness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <vector>

#include "fifty_digits.hpp"
#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;

CriticalStiffness critical(const DeviceParameters& parameters) {
  const Device device(parameters);
  const Wall& wall = device.parameters().wall;
  return critical_stiffness(filtered_plant(device), {wall.damping, wall.velocity_filter_hz});
}

double excess(const DeviceParameters& parameters, double stiffness) {
  const Device device(parameters);
  Wall wall = device.parameters().wall;
  wall.stiffness = stiffness;
  return stability_excess(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), wall);
}

// Eigenvalues agree with the stable intervals: in the middle of each interval and of each gap.
void expect_confirmed(const DeviceParameters& device) {
  const CriticalStiffness result = critical(device);
  std::vector<double> edges{0.0};
  for (const Crossover& crossover : result.crossovers) edges.push_back(crossover.stiffness);
  std::sort(edges.begin(), edges.end());
  edges.push_back(2.0 * edges.back() + 1.0);
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double middle = 0.5 * (edges[i] + edges[i + 1]);
    const bool stable = std::any_of(result.stable_intervals.begin(), result.stable_intervals.end(),
                                    [middle](const StableInterval& interval) {
                                      return interval.lower < middle && (!interval.upper || middle < *interval.upper);
                                    });
    EXPECT_EQ(excess(device, middle) < 0.0, stable) << "K " << middle << ", excess " << excess(device, middle);
  }
}

DeviceParameters mass(double delay) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies[0] = {"mass", 2.0, 0.0, 0.0, 0.0};
  device.loop.delay = delay;
  return device;
}

// z² + (K g - 2) z + 1 + K g: |z| > 1 for every K > 0. One real crossing more: none, since P(-1) = 0.
TEST(CriticalStiffness, UndampedFreeMassHasNone) {
  for (const double delay : {0.0, 0.3e-3, 1e-3, 4.5e-3}) {
    const CriticalStiffness result = critical(mass(delay));
    EXPECT_EQ(result.status, StiffnessStatus::none_stable) << delay;
    EXPECT_EQ(result.stiffness, 0.0);
    EXPECT_FALSE(result.limit.has_value());
    EXPECT_TRUE(result.stable_intervals.empty());
    expect_confirmed(mass(delay));
  }
  EXPECT_TRUE(critical(mass(0.0)).crossovers.empty());
}

// A grounded, undamped mass-spring: at a small K > 0 the held force lags the motion and feeds it.
TEST(CriticalStiffness, UndampedVibrationHasNone) {
  for (const double delay : {0.0, 0.5e-3, 2e-3}) {
    DeviceParameters device = mass(delay);
    device.bodies[0].stiffness = 800.0;
    const CriticalStiffness result = critical(device);
    EXPECT_EQ(result.status, StiffnessStatus::none_stable) << delay;
    expect_confirmed(device);
  }
}

// With a lag of more than half a turn at the mode the sign turns: the same wall damps it.
TEST(CriticalStiffness, UndampedVibrationIsDampedByALongDelay) {
  DeviceParameters device = mass(0.2);  // w = 20 rad/s: 4 rad of delay
  device.loop.sampling_period = 1e-2;
  device.bodies[0].stiffness = 800.0;
  const CriticalStiffness result = critical(device);
  ASSERT_EQ(result.status, StiffnessStatus::finite);
  EXPECT_LT(excess(device, 0.5 * result.stiffness), 0.0);
  EXPECT_GT(excess(device, 1.01 * result.stiffness), 0.0);
  expect_confirmed(device);
}

TEST(CriticalStiffness, UndampedTwoMasses) {
  DeviceParameters device = test::lhifam_parameters();
  device.links[0].damping = 0.0;
  device.bodies[0].damping = device.bodies[1].damping = 0.0;
  for (const double delay : {0.0, 0.25e-3}) {
    EXPECT_EQ(critical(test::with_delay(device, delay)).status, StiffnessStatus::none_stable);
    expect_confirmed(test::with_delay(device, delay));
    expect_confirmed(test::handle_sensed(test::with_delay(device, delay)));
  }
}

// Undamped cable between bodies with damping to ground: all poles inside, lightly.
TEST(CriticalStiffness, LightlyDampedTwoMasses) {
  DeviceParameters device = test::lhifam_parameters();
  device.links[0].damping = 0.0;
  for (const double delay : {0.0, 0.25e-3, 3e-3}) {
    expect_confirmed(test::with_delay(device, delay));
    expect_confirmed(test::handle_sensed(test::with_delay(device, delay)));
  }
}

// -1/(s + 1): z - a - K (1 - a) = 0 leaves the circle at z = 1, which is no crossover; K > 1 is unstable.
TEST(CriticalStiffness, NegativeGain) {
  const DeviceParameters device = test::transfer_function_parameters({-1.0}, {1.0, 1.0}, 0.1);
  EXPECT_LT(excess(device, 0.99), 0.0);
  EXPECT_GT(excess(device, 1.01), 0.0);
  const CriticalStiffness result = critical(device);
  ASSERT_EQ(result.status, StiffnessStatus::finite);
  EXPECT_NEAR(result.stiffness, 1.0, 1e-12);
}

// -1/s pushes the pole at 1 outwards at once.
TEST(CriticalStiffness, NegativeIntegrator) {
  EXPECT_EQ(critical(test::transfer_function_parameters({-1.0}, {1.0, 0.0}, 0.1)).status, StiffnessStatus::none_stable);
  EXPECT_EQ(critical(test::transfer_function_parameters({-1.0}, {1.0, 2.0, 0.0}, 0.1)).status,
            StiffnessStatus::none_stable);
}

// 1/s held for T = 0.1: z = 1 - K T, stable until K = 20.
TEST(CriticalStiffness, Integrator) {
  const CriticalStiffness result = critical(test::transfer_function_parameters({1.0}, {1.0, 0.0}, 0.1));
  ASSERT_EQ(result.status, StiffnessStatus::finite);
  EXPECT_NEAR(result.stiffness, 20.0, 1e-13);
  ASSERT_EQ(result.crossovers.size(), 1U);
  EXPECT_EQ(result.crossovers[0].frequency, pi / 0.1);
  EXPECT_EQ(result.crossovers[0].poles_leaving, 1);
}

// An unstable plant needs a least K: z = e^T - K (e^T - 1), stable for 1 < K < coth(T/2).
TEST(CriticalStiffness, UnstablePlantHasAnIntervalFurtherUp) {
  const double period = 0.2;
  const DeviceParameters device = test::transfer_function_parameters({1.0}, {1.0, -1.0}, period);
  EXPECT_LT(excess(device, 1.01), 0.0);
  EXPECT_GT(excess(device, 0.99), 0.0);
  const CriticalStiffness result = critical(device);
  EXPECT_EQ(result.status, StiffnessStatus::none_stable);
  ASSERT_EQ(result.stable_intervals.size(), 1U);
  EXPECT_NEAR(result.stable_intervals[0].lower, 1.0, 1e-12);
  ASSERT_TRUE(result.stable_intervals[0].upper.has_value());
  EXPECT_NEAR(*result.stable_intervals[0].upper, 1.0 / std::tanh(period / 2.0), 1e-12);
}

// No K destabilises a plant whose last pole ends in a zero at Nyquist.
TEST(CriticalStiffness, UnboundedWhereNoPoleLeaves) {
  // A sampled plant of its own: P = 0.5 (z + 1)/(z - 0.5). Closed: z = (0.5 - K/2)/(1 + K/2), inside for every K > 0.
  SampledPlant plant;
  plant.period = 1e-3;
  SampledTerm term;
  term.degree = 1;
  term.numerator[0] = 1.0;  // 0.5 (delta + 2)
  term.numerator[1] = 0.5;
  term.denominator[0] = 0.5;
  plant.terms.push_back(term);
  const CriticalStiffness result = critical_stiffness(filtered_plant(plant, {}));
  EXPECT_EQ(result.status, StiffnessStatus::unbounded);
  EXPECT_EQ(result.stiffness, std::numeric_limits<double>::infinity());
  EXPECT_FALSE(result.limit.has_value());
  ASSERT_EQ(result.stable_intervals.size(), 1U);
  EXPECT_EQ(result.stable_intervals[0].lower, 0.0);
  EXPECT_FALSE(result.stable_intervals[0].upper.has_value());
}

// A virtual damper beyond the one of stability: no K > 0 makes it good, eigenvalues say.
TEST(CriticalStiffness, TooMuchVirtualDamping) {
  DeviceParameters device = test::rigid_parameters();
  device.wall.damping = 12000.0;  // m/T = 5400: the pole near Nyquist is outside
  EXPECT_GT(excess(device, 1e-3), 0.0);
  const CriticalStiffness result = critical(device);
  EXPECT_EQ(result.status, StiffnessStatus::none_stable);
  EXPECT_EQ(result.stiffness, 0.0);
  expect_confirmed(device);
}

TEST(CriticalStiffness, AgreesWithEigenvaluesOverDampersFiltersAndDelays) {
  for (const double damping : {0.0, 1.0, 20.0, 300.0, 1500.0, 4000.0, 9000.0}) {
    for (const double filter : {0.0, 5.0, 80.0}) {
      for (const double delay : {0.0, 0.4e-3, 2e-3}) {
        for (DeviceParameters device :
             {test::rigid_parameters(), test::lhifam_parameters(), test::reduced_pretension_parameters(),
              test::handle_sensed(test::lhifam_parameters())}) {
          device.wall.damping = damping;
          device.wall.velocity_filter_hz = filter;
          device.loop.delay = delay;
          SCOPED_TRACE(testing::Message() << device.name << " B " << damping << " f " << filter << " t_d " << delay);
          expect_confirmed(device);
        }
      }
    }
  }
}

// m = 1, b = 0.5 and 1.75 across, k = 2: the mode is (s + 2)² exactly.
TEST(CriticalStiffness, CriticallyDampedMode) {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies = {{"motor", 1.0, 0.5, 0.0, 0.0}, {"handle", 1.0, 0.5, 0.0, 0.0}};
  device.links = {{0, 1, 2.0, 1.75}};
  const CriticalStiffness result = critical(device);
  ASSERT_EQ(result.status, StiffnessStatus::finite);
  EXPECT_NEAR(result.stiffness, 4501.74, 0.01);  // roots of the characteristic polynomial in double precision
  const test::ExactSampledDevice exact(test::exact_state_space(Device(device)), {1e-3, 0.0});
  EXPECT_LE(test::relative_error(-1.0 / result.stiffness, exact.response(result.limit->frequency)), 1e-9);
  expect_confirmed(device);
}

// Multiple poles of a transfer function; values by the roots of the characteristic polynomial.
TEST(CriticalStiffness, MultiplePoles) {
  const CriticalStiffness twofold = critical(test::transfer_function_parameters({2.0, 1.0}, {1.0, 10.0, 25.0}, 1e-3));
  EXPECT_NEAR(twofold.stiffness, 1000.00583, 1e-5);
  const CriticalStiffness threefold = critical(test::transfer_function_parameters({1.0}, {1.0, 3.0, 3.0, 1.0}, 0.1));
  EXPECT_NEAR(threefold.stiffness, 6.985324613, 1e-9);
}

// Every crossover is on the circle: 1 + (K + B v) P = 0 there.
TEST(CriticalStiffness, CrossoversSolveTheCharacteristicEquation) {
  DeviceParameters device = test::lhifam_parameters();
  device.loop.delay = 2.6e-3;
  device.wall.damping = 3.0;
  device.wall.velocity_filter_hz = 50.0;
  const SampledPlant plant = sampled_plant(Device(device));
  const CriticalStiffness result = critical(device);
  const double a = std::exp(-2.0 * pi * 50.0 * 1e-3);
  ASSERT_GE(result.crossovers.size(), 3U);
  for (const Crossover& crossover : result.crossovers) {
    const std::complex<double> z = std::polar(1.0, crossover.frequency * 1e-3);
    const std::complex<double> v = (1.0 - 1.0 / z) / 1e-3 * (1.0 - a) / (1.0 - a / z);
    const std::complex<double> loop = (crossover.stiffness + 3.0 * v) * response(plant, crossover.frequency);
    EXPECT_LE(std::abs(1.0 + loop), 1e-9 * (1.0 + std::abs(loop)));
  }
}

TEST(CriticalStiffness, InvalidDamperThrows) {
  const FilteredPlant plant = filtered_plant(Device(test::rigid_parameters()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const VirtualDamper damper : {VirtualDamper{-1.0, 0.0}, VirtualDamper{1.0, -5.0}, VirtualDamper{nan, 0.0},
                                     VirtualDamper{1.0, std::numeric_limits<double>::infinity()}}) {
    try {
      (void)critical_stiffness(plant, damper);
      FAIL() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::invalid_argument);
    }
  }
}

}  // namespace
}  // namespace zwidth
