// Modes that nothing damps but the wall's damper: poles within 1e-8 of the unit circle, crossovers beside them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "exact_closed_loop.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

DeviceParameters chain() {
  DeviceParameters d;
  d.name = "undamped chain";
  d.bodies = {{"b0", 5.25483, 0, 0, 0}, {"b1", 0.169625, 0, 0, 0}, {"b2", 0.365707, 0, 0, 0}, {"b3", 2.44398, 0, 0, 0}};
  d.links = {{0, 1, 6339.9, 0}, {1, 2, 3903.09, 0}, {2, 3, 10152.0, 0}};
  d.loop.held = 3;
  d.loop.sampling_period = 5e-4;
  d.wall.damping = 0.150921;
  d.wall.velocity_filter_hz = 253.658;
  for (const double pole : {0.014749, 0.27738}) {
    WallFilter filter;
    filter.kind = WallFilter::Kind::digital;
    filter.numerator = {pole < 0.1 ? 1.0147 : 1.2774, 0.0};
    filter.denominator = {1.0, pole};
    d.wall.filters.push_back(filter);
  }
  return d;
}

// K_CR by mpmath with 150 digits: roots on the circle of the closed loop's characteristic polynomial, which comes of
// the exponential of the state matrix; confirmed by Schur and Cohn's count and by the roots' moduli. The crossing lies
// within 1e-6 of the mode's own frequency, of which it was taken for the pole: "none stable", and surely.
TEST(UndampedModes, AreLeftByTheirOwnCrossoversNotByTheirPoles) {
  struct Case {
    double delay;
    double stiffness;
  };
  for (const auto& [delay, stiffness] : {Case{0.0, 1084.882416082739},
                                         {1.25e-3, 94.48382438307395},
                                         {2.5e-3, 39.70069466692645},
                                         {3.75e-3, 16.81455561274804},
                                         {5e-3, 1.8183854205748105}}) {
    DeviceParameters parameters = chain();
    parameters.loop.delay = delay;
    const CriticalStiffness answer = critical_stiffness(Device(parameters));
    EXPECT_EQ(answer.status, StiffnessStatus::finite) << delay;
    EXPECT_TRUE(answer.trust.sound()) << delay;
    EXPECT_NEAR(answer.stiffness, stiffness, 1e-12 * stiffness) << delay;
  }
}

// mpmath with 90 digits: of the two roots beside the mode of 1685.7 rad/s one has K = 9.08e9, the other a negative K. In
// double precision that was 5.7 > 0.
TEST(UndampedModes, HaveNoCrossoverWhereKIsNegative) {
  DeviceParameters parameters;
  parameters.name = "undamped chain";
  parameters.bodies = {
      {"b0", 0.18618, 0, 0, 0}, {"b1", 0.597235, 0, 0, 0}, {"b2", 1.34494, 0, 0, 0}, {"b3", 0.0660233, 0, 0, 0}};
  parameters.links = {{0, 1, 6677.43, 0}, {1, 2, 32422.0, 0}, {2, 3, 178759.0, 0}};
  parameters.loop.held = 3;
  parameters.loop.sampling_period = 5e-4;
  parameters.loop.delay = 5.81451e-4;
  parameters.wall.damping = 0.0150647;
  WallFilter filter;
  filter.kind = WallFilter::Kind::low_pass;
  filter.frequency_hz = 30.2912;
  filter.order = 2;
  filter.damping_ratio = 0.600832;
  parameters.wall.filters = {filter};
  const CriticalStiffness answer = critical_stiffness(Device(parameters));
  ASSERT_EQ(answer.crossovers.size(), 3U);
  EXPECT_NEAR(answer.crossovers[0].stiffness, 2.10971234737, 1e-10);
  EXPECT_NEAR(answer.crossovers[1].stiffness, 9083389377.35, 0.1);
  EXPECT_NEAR(answer.crossovers[2].stiffness, 2471993442.0, 0.1);
}

// The mode of 2576 rad/s has a damping ratio of 1.2e-15: it was taken for undamped, left at K = 0, and no wall was stable.
// mpmath with 60 digits, on the exponential of the state matrix.
TEST(UndampedModes, AModeThatIsHardlyDampedLeavesWhereItsDampingIsUsedUp) {
  DeviceParameters parameters;
  parameters.name = "hardly damped";
  parameters.bodies = {
      {"b0", 0.1, 0, 0, 0}, {"b1", 1, 0, 0, 0}, {"b2", 0.2, 0, 0, 0}, {"b3", 1, 0.09, 0, 0}, {"b4", 2, 0, 0, 0}};
  parameters.links = {{0, 1, 6e5, 0}, {1, 2, 1e3, 0}, {2, 3, 2e5, 0}, {0, 4, 4e3, 0}};
  parameters.loop.actuated = parameters.loop.sensed = 4;
  parameters.loop.held = 0;
  parameters.loop.sampling_period = 2e-3;
  const CriticalStiffness answer = critical_stiffness(Device(parameters));
  EXPECT_TRUE(answer.trust.sound());
  ASSERT_EQ(answer.status, StiffnessStatus::finite);
  EXPECT_NEAR(answer.stiffness / 0.17412859407525473539, 1.0, 1e-12);
  EXPECT_NEAR(answer.limit->frequency / 565.45512744883832871, 1.0, 1e-12);
  EXPECT_EQ(answer.limit->poles_leaving, 2);
  EXPECT_NEAR(answer.crossovers.back().stiffness / 2.4002734373963357488e+23, 1.0, 1e-9);
}

// Chains whose modes are damped by one tiny damper far away, down to ratios of 1e-18: each crossover is one.
TEST(UndampedModes, HardlyDampedModesAreCountedRight) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    std::mt19937_64 random(seed);
    const auto log_uniform = [&](double least, double most) {
      return std::exp(std::uniform_real_distribution(std::log(least), std::log(most))(random));
    };
    DeviceParameters parameters;
    parameters.name = "hardly damped";
    const std::size_t count = 2 + random() % 3;
    for (std::size_t i = 0; i < count; ++i) {
      parameters.bodies.push_back({"b" + std::to_string(i), log_uniform(0.05, 3.0), 0.0, 0.0, 0.0});
      if (i > 0) parameters.links.push_back({i - 1, i, log_uniform(1e3, 1e6), 0.0});
    }
    const std::size_t damped = random() % count;
    parameters.bodies[damped].damping = log_uniform(1e-8, 1e-1);
    parameters.loop.sampling_period = 1e-3 * static_cast<double>(1 + random() % 2);
    parameters.loop.delay = random() % 3 == 0 ? 0.3e-3 : 0.0;
    const Device device(parameters);
    const CriticalStiffness answer = critical_stiffness(device);
    EXPECT_TRUE(answer.trust.sound()) << "seed " << seed;
    const test::ExactClosedLoop loop(device);
    double softest = 1e300;
    for (const Crossover& each : answer.crossovers) softest = std::min(softest, each.stiffness);
    for (const Crossover& each : answer.crossovers) {
      if (each.stiffness > 1e12 * softest) continue;  // where the response is rounding of its terms
      EXPECT_EQ(loop.poles_outside((1.0 + 1e-9) * each.stiffness) - loop.poles_outside((1.0 - 1e-9) * each.stiffness),
                each.poles_leaving)
          << "seed " << seed << " K = " << each.stiffness;
    }
    if (answer.status == StiffnessStatus::none_stable) {
      EXPECT_GT(loop.poles_outside(0.5 * std::min(softest, 1e6)), 0) << "seed " << seed;
    }
    if (answer.status == StiffnessStatus::finite) {
      for (const double share : {1e-6, 1e-3, 0.5, 1.0 - 1e-9}) {
        EXPECT_EQ(loop.poles_outside(share * answer.stiffness), 0) << "seed " << seed << " x " << share;
      }
    }
  }
}

}  // namespace
}  // namespace zwidth
