#include "continuous_margins.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "zwidth/error.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;

constexpr double tolerance = 1e-11;

// 1/s: gain crossover at 1 rad/s, 90 degrees.
TEST(ContinuousMargins, Integrator) {
  const LoopMargins margins = test::continuous_margins({{1.0}, {1.0, 0.0}});
  EXPECT_TRUE(margins.stable);
  EXPECT_FALSE(margins.gain_margin.has_value());
  EXPECT_FALSE(margins.lower_gain_margin.has_value());
  ASSERT_EQ(margins.gain_crossovers.size(), 1U);
  EXPECT_NEAR(margins.gain_crossovers[0].frequency, 1.0, tolerance);
  EXPECT_NEAR(margins.phase_margin.value(), pi / 2.0, tolerance);
  EXPECT_NEAR(margins.delay_margin.value(), pi / 2.0, tolerance);
}

// k / (s (s + 1)(s + 2)): phase -180 degrees at sqrt 2, |L| = k/6 there.
TEST(ContinuousMargins, KhalilsPlant) {
  const double k = 0.5;
  const LoopMargins margins = test::continuous_margins({{k}, {1.0, 3.0, 2.0, 0.0}});
  EXPECT_TRUE(margins.stable);
  EXPECT_NEAR(margins.gain_margin.value(), 6.0 / k, 6.0 / k * tolerance);
  ASSERT_EQ(margins.gain_crossovers.size(), 1U);
  const double w = margins.gain_crossovers[0].frequency;
  EXPECT_NEAR(w * std::hypot(w, 1.0) * std::hypot(w, 2.0), k, tolerance);
  const double phase = pi / 2.0 - std::atan(w) - std::atan(w / 2.0);
  EXPECT_NEAR(margins.phase_margin.value(), phase, tolerance);
  EXPECT_NEAR(margins.delay_margin.value(), phase / w, tolerance);
  EXPECT_FALSE(test::continuous_margins({{6.1}, {1.0, 3.0, 2.0, 0.0}}).stable);
  EXPECT_TRUE(test::continuous_margins({{5.9}, {1.0, 3.0, 2.0, 0.0}}).stable);
}

// 2/(s - 1) is stabilised by its loop; half the gain loses it.
TEST(ContinuousMargins, UnstablePlantHasALowerMargin) {
  const LoopMargins margins = test::continuous_margins({{2.0}, {1.0, -1.0}});
  EXPECT_TRUE(margins.stable);
  EXPECT_FALSE(margins.gain_margin.has_value());
  // 1 + kappa L = 0 at s = 0 for kappa = 1/2
  ASSERT_TRUE(margins.lower_gain_margin.has_value());
  EXPECT_NEAR(*margins.lower_gain_margin, 0.5, tolerance);
  ASSERT_EQ(margins.gain_crossovers.size(), 1U);
  EXPECT_NEAR(margins.gain_crossovers[0].frequency, std::sqrt(3.0), tolerance);
  EXPECT_NEAR(margins.phase_margin.value(), pi / 3.0, tolerance);  // arg 2/(j sqrt 3 - 1) = -120 degrees
}

TEST(ContinuousMargins, UnstableLoopHasNone) {
  const LoopMargins margins = test::continuous_margins({{1.0}, {1.0, 0.0, 0.0}});  // an undamped oscillation
  EXPECT_FALSE(margins.stable);
  EXPECT_FALSE(margins.gain_margin.has_value());
  EXPECT_FALSE(margins.phase_margin.has_value());
  EXPECT_FALSE(margins.delay_margin.has_value());
}

// Gain below 1 everywhere: nothing to lose by delay.
TEST(ContinuousMargins, SmallLoopHasNoDelayMargin) {
  const LoopMargins margins = test::continuous_margins({{0.5}, {1.0, 1.0}});
  EXPECT_TRUE(margins.stable);
  EXPECT_TRUE(margins.gain_crossovers.empty());
  EXPECT_FALSE(margins.phase_margin.has_value());
  EXPECT_FALSE(margins.delay_margin.has_value());
}

// A resonance crosses gain 1 three times; the least delay decides, not the least phase.
TEST(ContinuousMargins, DelayMarginIsOverAllGainCrossovers) {
  // 0.5/s + resonance at 20 rad/s: residue such that |L| peaks above 1 there
  const TransferFunction loop{{2.5, 0.2, 200.0},
                              {1.0, 0.4, 400.0, 0.0}};  // (2.5 s² + 0.2 s + 200)/(s (s² + 0.4 s + 400))
  const LoopMargins margins = test::continuous_margins(loop);
  ASSERT_TRUE(margins.stable);
  ASSERT_EQ(margins.gain_crossovers.size(), 3U);
  double least_delay = 1e9;
  double least_phase = 1e9;
  for (const GainCrossover& crossover : margins.gain_crossovers) {
    const std::complex<double> s(0.0, crossover.frequency);
    const std::complex<double> l = (2.5 * s * s + 0.2 * s + 200.0) / (s * (s * s + 0.4 * s + 400.0));
    EXPECT_NEAR(std::abs(l), 1.0, 1e-10);
    EXPECT_NEAR(crossover.phase_margin, std::arg(-l), 1e-10);
    const double lag = std::arg(-l) < 0.0 ? std::arg(-l) + 2.0 * pi : std::arg(-l);
    least_delay = std::min(least_delay, lag / crossover.frequency);
    least_phase = std::min(least_phase, std::abs(std::arg(-l)));
  }
  EXPECT_NEAR(margins.delay_margin.value(), least_delay, 1e-10 * least_delay);
  EXPECT_NEAR(margins.phase_margin.value(), least_phase, 1e-10 * least_phase);
}

TEST(ContinuousMargins, ScalesWithTime) {
  for (const double c : {1e-4, 1e4}) {  // s -> s c
    const LoopMargins margins = test::continuous_margins({{25.0}, {c * c * c, 10.0 * c * c, 10.0 * c, 10.0}});
    EXPECT_NEAR(margins.gain_margin.value(), 3.6, 1e-10);
    EXPECT_NEAR(margins.phase_margin.value() * 180.0 / pi, 29.1104, 1e-4);
    EXPECT_NEAR(margins.delay_margin.value() / c, 0.2847, 1e-4);
  }
}

TEST(ContinuousMargins, NotStrictlyProperThrows) {
  EXPECT_THROW((void)test::continuous_margins({{1.0, 1.0}, {1.0, 2.0}}), Error);
}

}  // namespace
}  // namespace zwidth
