#include "zwidth/rig/oscillation_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace zwidth {
namespace {

constexpr double period = 1e-3;
const std::vector<double> watched{40.0, 300.0};

template <typename Motion>
int cycles_until_detected(OscillationWatch& watch, int cycles, const Motion& motion) {
  for (int k = 0; k < cycles; ++k) {
    if (watch.update(motion(period * k))) return k;
  }
  return -1;
}

TEST(OscillationWatch, SeesOneGrow) {
  for (const double frequency : {40.0, 44.0, 300.0, 280.0}) {
    OscillationWatch watch(watched, period, 1e-5);
    const auto grows = [&](double t) { return 1e-3 * std::exp(0.02 * frequency * t) * std::sin(frequency * t); };
    const int at = cycles_until_detected(watch, 20000, grows);
    ASSERT_GE(at, 0) << frequency;
    EXPECT_LT(at * period * frequency / 6.2832, 45.0) << "cycles of " << frequency << " rad/s";
    EXPECT_NEAR(watch.frequency(), frequency, 0.2 * frequency);
  }
}

TEST(OscillationWatch, SeesOneGrowWhereNoneIsPredicted) {
  for (const double frequency : {80.0, 120.0, 700.0}) {
    OscillationWatch watch(watched, period, 1e-5);
    const auto grows = [&](double t) { return 1e-3 * std::exp(0.02 * frequency * t) * std::sin(frequency * t); };
    EXPECT_GE(cycles_until_detected(watch, 20000, grows), 0) << frequency;
    EXPECT_NEAR(watch.frequency(), frequency, 0.1 * frequency);
  }
}

TEST(OscillationWatch, SeesNoneThatStaysOrDecays) {
  for (const double rate : {0.0, -0.001, -0.05}) {
    OscillationWatch watch(watched, period, 1e-5);
    const auto rings = [&](double t) { return 1e-3 * std::exp(rate * 40.0 * t) * std::sin(40.0 * t) + 5e-3; };
    EXPECT_EQ(cycles_until_detected(watch, 20000, rings), -1) << rate;
  }
}

TEST(OscillationWatch, SeesNoneInWhatAUserDoes) {
  OscillationWatch pushed(watched, period, 1e-5);
  EXPECT_EQ(cycles_until_detected(pushed, 20000, [](double t) { return 1e-2 * t; }), -1);
  OscillationWatch moved(watched, period, 1e-5);
  EXPECT_EQ(cycles_until_detected(moved, 20000, [](double t) { return 1e-2 * t * std::sin(4.0 * t); }), -1);
  OscillationWatch below(watched, period, 1e-2);
  EXPECT_EQ(cycles_until_detected(below, 4000, [](double t) { return 1e-6 * std::exp(t) * std::sin(40.0 * t); }), -1);
}

// Where a slow swing turns round, in the few samples of a window of a fast one, it is nearly constant: what a constant
// leaks into the window rose with the swing, was more than all that varied, and took stable walls away.
TEST(OscillationWatch, SeesNoFastOneInASlowOne) {
  const std::vector<double> slow_and_fast{9.4, 2256.0};
  for (const double rate : {0.0, -0.02, -0.3}) {
    for (const double offset : {0.0, 5e-3, 1.0}) {
      OscillationWatch watch(slow_and_fast, period, 0.0);
      const auto rings = [&](double t) { return offset * t + 5e-3 * std::exp(rate * t) * std::sin(9.4 * t); };
      EXPECT_EQ(cycles_until_detected(watch, 20000, rings), -1) << rate << ", " << offset;
    }
  }
}

TEST(OscillationWatch, TellsWhatSwingsMostAndHowItGrows) {
  constexpr double rate = 0.7;  // 1/s
  const std::vector<double> frequencies{60.0, 200.0};
  OscillationWatch watch(frequencies, period, 0.0);
  EXPECT_EQ(watch.strongest().amplitude, 0.0) << "no whole window yet";
  double t = 0.0;
  for (int k = 0; k < 4000; ++k) {
    t = k * period;
    watch.update(1e-3 * std::exp(rate * t) * std::sin(60.0 * t) + 1e-4 * std::sin(200.0 * t));
  }
  const WatchedSwing swing = watch.strongest();
  EXPECT_EQ(swing.frequency, 60.0);
  EXPECT_NEAR(swing.growth_rate, rate, 0.05 * rate);
  EXPECT_LT(swing.amplitude, 1e-3 * std::exp(rate * t));
  EXPECT_GT(swing.amplitude, 1e-3 * std::exp(rate * (t - 1.3)));  // two windows of 0.63 s before
}

}  // namespace
}  // namespace zwidth
