#include "zwidth/rig/force_guard.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

constexpr double period = 1e-3;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

SafetyLimits limits() {
  SafetyLimits limits;
  limits.missed_cycles = 3;
  limits.force = 5.0;
  limits.position = 0.1;
  limits.velocity = 2.0;
  limits.saturation_duration = 0.01;
  limits.ramp = 0.0;
  return limits;
}

TEST(ForceGuard, LetsThroughWhatIsAllowed) {
  ForceGuard guard(limits(), period);
  for (int k = 0; k < 1000; ++k) {
    EXPECT_EQ(guard.update(1e-3 * std::sin(0.01 * k), 4.0), 4.0);
  }
  EXPECT_EQ(guard.stopped(), StopReason::none);
}

TEST(ForceGuard, TheForceGrowsFromZero) {
  SafetyLimits ramped = limits();
  ramped.ramp = 0.1;
  ForceGuard guard(ramped, period);
  double last = 0.0;
  for (int k = 0; k < 100; ++k) {
    const double force = guard.update(0.0, 1.0);
    EXPECT_NEAR(force, 0.01 * (k + 1), 1e-12);
    EXPECT_GT(force, last);
    last = force;
  }
  EXPECT_EQ(guard.update(0.0, 1.0), 1.0);
  guard.restart();
  EXPECT_NEAR(guard.update(0.0, 1.0), 0.01, 1e-12);
}

// Each stretch of a swing at the limit is short; to and fro it shook the device without end.
TEST(ForceGuard, ASwingBetweenTheLimitsIsSaturationToo) {
  const auto cycles_until_stopped = [](double amplitude) {
    ForceGuard guard(limits(), period);  // cuts off at 5, for 10 cycles
    for (int k = 0; k < 1000; ++k) {
      (void)guard.update(0.0, amplitude * std::sin(0.5 * k));
      if (guard.stopped() != StopReason::none) return k;
    }
    return -1;
  };
  EXPECT_EQ(cycles_until_stopped(4.9), -1);
  EXPECT_EQ(cycles_until_stopped(6.0), -1) << "cut off for a third of the time";
  const int swinging = cycles_until_stopped(20.0);
  EXPECT_GT(swinging, 10);
  EXPECT_LT(swinging, 40);
}

struct Fault {
  const char* name;
  StopReason reason;
  int cycles;  // within which the force is zero
  std::function<double(ForceGuard&, int)> cycle;
};

class EachFault : public testing::TestWithParam<Fault> {};

TEST_P(EachFault, IsZeroForceInTimeAndForGood) {
  const Fault& fault = GetParam();
  ForceGuard guard(limits(), period);
  for (int k = 0; k < 50; ++k) ASSERT_EQ(guard.update(0.01, 3.0), 3.0);
  double force = 3.0;
  int k = 0;
  while (guard.stopped() == StopReason::none && k < 1000) force = fault.cycle(guard, k++);
  EXPECT_EQ(guard.stopped(), fault.reason);
  EXPECT_LE(k, fault.cycles);
  EXPECT_EQ(force, 0.0);
  guard.restart();
  for (int i = 0; i < 10; ++i) EXPECT_EQ(guard.update(0.01, 3.0), 0.0);
  guard.stop(StopReason::interrupted);
  EXPECT_EQ(guard.stopped(), fault.reason) << "the first reason stays";
}

INSTANTIATE_TEST_SUITE_P(
    Guard, EachFault,
    testing::Values(Fault{"position is no number", StopReason::not_a_number, 1,
                          [](ForceGuard& g, int) { return g.update(nan, 3.0); }},
                    Fault{"force is no number", StopReason::not_a_number, 1,
                          [](ForceGuard& g, int) { return g.update(0.01, nan); }},
                    Fault{"infinite force", StopReason::not_a_number, 1,
                          [](ForceGuard& g, int) { return g.update(0.01, std::numeric_limits<double>::infinity()); }},
                    Fault{"too far", StopReason::position_limit, 200,
                          [](ForceGuard& g, int k) { return g.update(0.01 + 1e-3 * k, 3.0); }},
                    Fault{"too fast", StopReason::velocity_limit, 3,
                          [](ForceGuard& g, int k) { return g.update(0.01 + 0.02 * k, 3.0); }},
                    Fault{"saturated", StopReason::saturation, 11,
                          [](ForceGuard& g, int) { return g.update(0.01, -50.0); }},
                    Fault{"no position", StopReason::lost_link, 3, [](ForceGuard& g, int) { return g.no_position(); }},
                    Fault{"late", StopReason::missed_cycles, 3,
                          [](ForceGuard& g, int) {
                            g.missed(1);
                            return g.update(0.01, 3.0);
                          }},
                    Fault{"late at once", StopReason::missed_cycles, 1,
                          [](ForceGuard& g, int) {
                            g.missed(3);
                            return g.update(0.01, 3.0);
                          }},
                    Fault{"interrupted", StopReason::interrupted, 1,
                          [](ForceGuard& g, int) {
                            g.stop(StopReason::interrupted);
                            return g.update(0.01, 3.0);
                          }}),
    [](const auto& fault) {
      std::string name = fault.param.name;
      std::erase(name, ' ');
      return name;
    });

TEST(ForceGuard, WhatIsBeyondTheLimitIsCutOff) {
  ForceGuard guard(limits(), period);
  EXPECT_EQ(guard.update(0.0, 50.0), 5.0);
  EXPECT_EQ(guard.update(0.0, -50.0), -5.0);
  for (int k = 0; k < 100; ++k) {  // within it for as long as beyond: that is allowed
    EXPECT_EQ(guard.update(0.0, k % 2 == 0 ? 1.0 : 50.0), k % 2 == 0 ? 1.0 : 5.0);
  }
  EXPECT_EQ(guard.stopped(), StopReason::none);
}

TEST(ForceGuard, ASingleLateCycleOrAMissingPositionIsBorne) {
  ForceGuard guard(limits(), period);
  EXPECT_EQ(guard.update(0.0, 3.0), 3.0);
  for (int k = 0; k < 100; ++k) {
    EXPECT_EQ(guard.no_position(), 3.0);
    EXPECT_EQ(guard.no_position(), 3.0);
    guard.missed(2);
    EXPECT_EQ(guard.update(0.0, 3.0), 3.0);
    guard.missed(0);
  }
  EXPECT_EQ(guard.stopped(), StopReason::none);
}

TEST(ForceGuard, RefusesLimitsThatAreNone) {
  const auto member = [](const std::function<void(SafetyLimits&)>& change) {
    SafetyLimits changed = limits();
    change(changed);
    const auto problem = find_problem(changed);
    return problem ? problem->member : "";
  };
  EXPECT_EQ(member([](SafetyLimits&) {}), "");
  EXPECT_EQ(member([](SafetyLimits& l) { l.force = 0.0; }), "force");
  EXPECT_EQ(member([](SafetyLimits& l) { l.position = -1.0; }), "position");
  EXPECT_EQ(member([](SafetyLimits& l) { l.velocity = nan; }), "velocity");
  EXPECT_EQ(member([](SafetyLimits& l) { l.saturation_duration = 0.0; }), "saturation_duration");
  EXPECT_EQ(member([](SafetyLimits& l) { l.missed_cycles = 0; }), "missed_cycles");
  EXPECT_EQ(member([](SafetyLimits& l) { l.missed_cycles = 1001; }), "missed_cycles");
  EXPECT_EQ(member([](SafetyLimits& l) { l.ramp = -1.0; }), "ramp");
  EXPECT_THROW(ForceGuard({.force = -1.0, .position = {}, .velocity = {}}, period), Error);
}

// Three late cycles of a loop of 1 kHz ended a session: 3 ms.
TEST(ForceGuard, AllowsAsManyMissedCyclesAsFitInto25ms) {
  EXPECT_EQ(allowed_missed_cycles(1e-3), 25U);
  EXPECT_EQ(allowed_missed_cycles(0.5e-3), 50U);
  EXPECT_EQ(allowed_missed_cycles(5e-3), 5U);
  EXPECT_EQ(allowed_missed_cycles(0.05), 3U);
  SafetyLimits limits;
  ForceGuard guard(limits, 1e-3);
  (void)guard.update(0.0, 0.0);
  for (int k = 0; k < 24; ++k) (void)guard.no_position();
  EXPECT_EQ(guard.stopped(), StopReason::none);
  (void)guard.no_position();
  EXPECT_EQ(guard.stopped(), StopReason::lost_link);
}

// Else the drive would let go while the rig still waits for it.
TEST(ForceGuard, TheDrivesWatchdogBoundsThem) {
  SafetyLimits limits;
  EXPECT_FALSE(find_problem(limits, 1e-3, 0.1));
  EXPECT_FALSE(find_problem(limits, 1e-3, 0.01)) << "what nobody gave is made to fit";
  limits.missed_cycles = 100;
  EXPECT_FALSE(find_problem(limits, 1e-3, 0.1));
  limits.missed_cycles = 101;
  const auto problem = find_problem(limits, 1e-3, 0.1);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->member, "missed_cycles");
  limits.missed_cycles = 3;
  EXPECT_FALSE(find_problem(limits, 0.05, 0.1)) << "three always are allowed";
}

}  // namespace
}  // namespace zwidth
