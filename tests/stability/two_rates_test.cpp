// A damper in a loop of its own.

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "../lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth {
namespace {

Device lhifam(double spring_period, double damper_period, double damping, std::optional<double> stiffness = {}) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.sampling_period = spring_period;
  parameters.loop.damper = LoopDamper{damper_period, 0.0};
  parameters.wall.damping = damping;
  parameters.wall.stiffness = stiffness;
  return Device(parameters);
}

Device with_delays(const Device& device, double of_spring, double of_damper) {
  DeviceParameters parameters = device.parameters();
  parameters.loop.delay += of_spring;
  parameters.loop.damper->delay = parameters.loop.damper->delay.value_or(0.0) + of_damper;
  return Device(parameters);
}

bool is_stable(const Device& device) { return wall_margins(device).stable; }

// theory, section 8.
TEST(TwoRates, LhifamWithADamperOnTheDrive) {
  EXPECT_NEAR(critical_stiffness(lhifam(1e-3, 1e-4, 0.0)).stiffness, 8848.7087, 1e-4);
  EXPECT_NEAR(critical_stiffness(lhifam(1e-3, 1e-4, 100.0)).stiffness, 252107.311, 1e-3);
  EXPECT_NEAR(critical_stiffness(lhifam(1e-3, 1e-4, 200.0)).stiffness, 500666.043, 1e-3);
}

TEST(TwoRates, LhifamWithASlowDamper) {
  EXPECT_NEAR(critical_stiffness(lhifam(1e-4, 1e-3, 0.0)).stiffness, 309679.688, 1e-3);
  EXPECT_NEAR(critical_stiffness(lhifam(1e-4, 1e-3, 100.0)).stiffness, 456719.274, 1e-3);
}

TEST(TwoRates, OfOneRateAreThatRateBitForBit) {
  const Device apart = lhifam(1e-3, 1e-3, 100.0, 5e4);
  const Device together = with_one_rate(apart);
  EXPECT_FALSE(has_damper_loop(apart.loop()));
  const Analysis first = analyze(apart);
  const Analysis second = analyze(together);
  EXPECT_EQ(first.critical.stiffness, second.critical.stiffness);
  ASSERT_EQ(first.critical.crossovers.size(), second.critical.crossovers.size());
  for (std::size_t i = 0; i < first.critical.crossovers.size(); ++i) {
    EXPECT_EQ(first.critical.crossovers[i].stiffness, second.critical.crossovers[i].stiffness);
    EXPECT_EQ(first.critical.crossovers[i].frequency, second.critical.crossovers[i].frequency);
  }
  EXPECT_EQ(first.any_user->stiffness, second.any_user->stiffness);
  EXPECT_EQ(first.wall->delay_margin, second.wall->delay_margin);
}

TEST(TwoRates, ADamperThatDoesNothingLeavesTheSpringItsRate) {
  const Device device = lhifam(1e-3, 1e-4, 0.0, 4000.0);
  const Analysis apart = analyze(device);
  const Analysis together = analyze(with_one_rate(device));
  EXPECT_EQ(apart.critical.stiffness, together.critical.stiffness);
  EXPECT_EQ(apart.wall->gain_margin, together.wall->gain_margin);
  ASSERT_TRUE(apart.any_user.has_value());
  EXPECT_EQ(apart.any_user->stiffness, together.any_user->stiffness);
  // The damper alone has the damper's rate.
  const Device of_damper = with_loop_of_damper(device);
  EXPECT_EQ(apart.limits.nobody.critical_damping, critical_damping(of_damper).damping);
  EXPECT_EQ(apart.limits.any_user->critical_damping, absolute_stability_damping(of_damper).damping);
}

TEST(TwoRates, LimitsSayWhatIsLeftOut) {
  const Analysis analysis = analyze(lhifam(1e-3, 1e-4, 100.0, 1e5));
  EXPECT_TRUE(analysis.trust.sound());
  EXPECT_FALSE(analysis.any_user.has_value());
  EXPECT_FALSE(analysis.q_criterion.has_value());
  int left_out = 0;
  for (const Remark& remark : analysis.remarks) {
    left_out += remark.finding && remark.finding->code == FindingCode::left_out_beside_damper_loop ? 1 : 0;
  }
  EXPECT_EQ(left_out, 3);  // Q, disk margin, any user
  EXPECT_EQ(analysis.critical.limit->limited_by.kind, Mechanism::Kind::vibration_mode);
}

// The margins beside the walls and delays that they name.
TEST(TwoRates, MarginsEndWhereTheLoopDoes) {
  for (const Device& device : {lhifam(1e-3, 1e-4, 100.0, 1e5), lhifam(1e-4, 1e-3, 100.0, 1e5)}) {
    const WallMargins margins = wall_margins(device);
    ASSERT_TRUE(margins.stable);
    EXPECT_LT(margins.spectral_radius, 1.0);
    const double limit = critical_stiffness(device).stiffness;
    ASSERT_TRUE(margins.stiffness_margin.has_value());
    EXPECT_NEAR(*margins.stiffness_margin, limit / 1e5, 1e-9 * limit / 1e5);
    for (const double share : {0.999, 1.001}) {
      const bool stays = share < 1.0;
      ASSERT_TRUE(margins.spring_delay_margin.has_value());
      EXPECT_EQ(is_stable(with_delays(device, share * *margins.spring_delay_margin, 0.0)), stays);
      ASSERT_TRUE(margins.damper_delay_margin.has_value());
      EXPECT_EQ(is_stable(with_delays(device, 0.0, share * *margins.damper_delay_margin)), stays);
      ASSERT_TRUE(margins.delay_margin.has_value());
      EXPECT_EQ(is_stable(with_delays(device, share * *margins.delay_margin, share * *margins.delay_margin)), stays);
    }
  }
}

TEST(TwoRates, AnIntervalIsThatOfTheTwoRates) {
  DeviceParameters parameters = lhifam(1e-3, 1e-4, 100.0).parameters();
  parameters.uncertainty = Uncertainty{.parameters = {"link.0.stiffness"}, .covariance = {{1e4}}};
  const Device device(parameters);
  const StiffnessInterval interval = stiffness_interval(device, 50);
  const double limit = critical_stiffness(device).stiffness;
  EXPECT_LE(interval.lower, limit);
  EXPECT_GE(interval.upper, limit);
  EXPECT_GT(interval.upper, interval.lower);
  EXPECT_LT(interval.upper / interval.lower, 1.05);
}

TEST(TwoRates, WhatKnowsOneRateAloneRefuses) {
  const Device device = lhifam(1e-3, 1e-4, 100.0, 1e5);
  EXPECT_THROW((void)filtered_plant(device), Error);
  EXPECT_THROW((void)virtual_damper(device), Error);
  EXPECT_THROW((void)absolute_stability_limit(device, {}), Error);
}

}  // namespace
}  // namespace zwidth
