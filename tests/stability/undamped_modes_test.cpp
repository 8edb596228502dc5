// Modes that nothing damps but the wall's damper: poles within 1e-8 of the unit circle, crossovers beside them.

#include <gtest/gtest.h>

#include <vector>

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

}  // namespace
}  // namespace zwidth
