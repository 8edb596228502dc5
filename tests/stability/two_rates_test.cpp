// A damper in a loop of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

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

// docs/theory.md, "Two rates".
TEST(TwoRates, LhifamWithADamperOnTheDrive) {
  EXPECT_NEAR(critical_stiffness(lhifam(1e-3, 1e-4, 0.0)).stiffness, 8848.7087, 1e-4);
  EXPECT_NEAR(critical_stiffness(lhifam(1e-3, 1e-4, 100.0)).stiffness, 252107.311, 1e-3);
  EXPECT_NEAR(critical_stiffness(lhifam(1e-3, 1e-4, 200.0)).stiffness, 500666.043, 1e-3);
}

TEST(TwoRates, LhifamWithASlowDamper) {
  EXPECT_NEAR(critical_stiffness(lhifam(1e-4, 1e-3, 0.0)).stiffness, 309679.688, 1e-3);
  EXPECT_NEAR(critical_stiffness(lhifam(1e-4, 1e-3, 100.0)).stiffness, 456719.274, 1e-3);
}

// 1/(s² (0.5 s + 0.4)), which only a damper makes stable: Routh's criterion without sampling says 0.8 at B = 1.
TEST(TwoRates, ASlowDamperHoldsWhatIsUnstableWithoutIt) {
  for (const double damper_period : {1e-3, 1e-5}) {
    DeviceParameters parameters = test::transfer_function_parameters({1.0}, {0.5, 0.4, 0.0, 0.0}, 1e-4);
    parameters.loop.damper = LoopDamper{damper_period, 0.0};
    parameters.wall.damping = 1.0;
    const CriticalStiffness critical = critical_stiffness(Device(parameters));
    EXPECT_TRUE(critical.trust.sound());
    EXPECT_NEAR(critical.stiffness, 0.8, 3e-3);
  }
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

// The factor on one force is no gain margin of both.
TEST(TwoRates, TheGainMarginOfBothForcesIsLeftOut) {
  for (const Device& device : {lhifam(1e-3, 1e-4, 100.0, 4000.0), lhifam(1e-4, 1e-3, 100.0, 4000.0)}) {
    const Analysis analysis = analyze(device);
    ASSERT_TRUE(analysis.wall && analysis.wall->stable);
    EXPECT_FALSE(analysis.wall->gain_margin || analysis.wall->lower_gain_margin);
    EXPECT_NEAR(*analysis.wall->stiffness_margin, analysis.critical.stiffness / 4000.0,
                1e-9 * analysis.critical.stiffness);
    const Finding left_out{.code = FindingCode::left_out_beside_damper_loop, .subjects = {{"what", "gain"}}};
    EXPECT_TRUE(std::ranges::any_of(analysis.remarks, [&](const Remark& each) {
      return each.finding && each.finding->code == left_out.code && each.finding->subjects == left_out.subjects;
    }));
  }
}

TEST(TwoRates, LimitsSayWhatIsLeftOut) {
  const Analysis analysis = analyze(lhifam(1e-3, 1e-4, 100.0, 1e5));
  EXPECT_TRUE(analysis.trust.sound());
  EXPECT_FALSE(analysis.q_criterion.has_value());
  int left_out = 0;
  for (const Remark& remark : analysis.remarks) {
    left_out += remark.finding && remark.finding->code == FindingCode::left_out_beside_damper_loop ? 1 : 0;
  }
  EXPECT_EQ(left_out, 3);  // Q, disk margin, gain margin
  EXPECT_EQ(analysis.critical.limit->limited_by.kind, Oscillator::Kind::vibration_mode);
}

// docs/theory.md, "Two rates".
TEST(TwoRates, AnyPassiveUserOfADamperOnTheDrive) {
  const std::pair<double, std::pair<double, double>> expected[] = {{50.0, {109169.96, 622.998}},
                                                                   {100.0, {218461.91, 837.748}}};
  for (const auto& [damping, limit] : expected) {
    const Analysis analysis = analyze(lhifam(1e-3, 1e-4, damping));
    ASSERT_TRUE(analysis.any_user.has_value());
    EXPECT_NEAR(analysis.any_user->stiffness / limit.first, 1.0, 1e-6);
    EXPECT_NEAR(analysis.any_user->frequency / limit.second, 1.0, 1e-5);
    EXPECT_EQ(analysis.limits.any_user->critical_stiffness, analysis.any_user->stiffness);
  }
}

// Springs, masses and dampers at the handle, random but for their seed: none destabilises a wall below the limit, and a spring
// does little above.
TEST(TwoRates, NoUserDestabilisesBelowTheLimitAndSomeSpringDoesAbove) {
  const Device device = lhifam(1e-3, 1e-4, 100.0);
  const double limit = analyze(device).any_user->stiffness;
  const auto limit_with = [&](const User& user) {
    DeviceParameters parameters = device.parameters();
    parameters.user = user;
    return critical_stiffness(Device(parameters)).stiffness;
  };
  std::mt19937_64 random(7);
  const auto value = [&](double low, double high) {
    return std::pow(10.0, std::uniform_real_distribution(low, high)(random));
  };
  for (int i = 0; i < 300; ++i) {
    const User user{value(-3.0, 2.0), value(-3.0, 3.0), value(1.0, 7.0)};
    EXPECT_GE(limit_with(user), limit * (1.0 - 1e-9)) << user.mass << ' ' << user.damping << ' ' << user.stiffness;
  }
  double least = std::numeric_limits<double>::infinity();
  for (double stiffness = 1e5; stiffness < 1e8; stiffness *= 1.01)
    least = std::min(least, limit_with({0.0, 0.0, stiffness}));
  EXPECT_GE(least, limit * (1.0 - 1e-9));
  EXPECT_LT(least, limit * (1.0 + 1e-3));
}

TEST(TwoRates, ASlowDamperLeavesTheUsersOut) {
  const Analysis analysis = analyze(lhifam(1e-4, 1e-3, 100.0));
  EXPECT_FALSE(analysis.any_user.has_value());
  EXPECT_TRUE(std::ranges::any_of(analysis.remarks, [](const Remark& remark) {
    return remark.finding && remark.finding->code == FindingCode::left_out_beside_damper_loop &&
           remark.finding->subjects.front().text == "any_user";
  }));
}

bool has_bound(const std::vector<Remark>& remarks) {
  return std::ranges::any_of(remarks, [](const Remark& remark) {
    return remark.finding && remark.finding->code == FindingCode::any_user_limit_scanned &&
           remark.finding->key == "loop.damper.delay";
  });
}

// Between the limits of the whole periods beside it, near to the exact ones that it joins, and no user destabilises below it.
TEST(TwoRates, ADelayOfAFractionLeavesABoundWithAnyUser) {
  const Device device = lhifam(1e-3, 1e-4, 100.0);
  const auto limit_at = [&](double later) {
    const Analysis analysis = analyze(with_delays(device, later * 1e-4, 0.0));
    EXPECT_EQ(has_bound(analysis.remarks), later != std::round(later)) << later;
    return analysis.any_user->stiffness;
  };
  const double none = limit_at(0.0);
  const double one = limit_at(1.0);
  const double half = limit_at(0.5);
  EXPECT_LT(half, none);
  EXPECT_GT(half, one);
  EXPECT_NEAR(limit_at(1e-3), none, 1e-3 * none);
  EXPECT_NEAR(limit_at(1.0 - 1e-3), one, 1e-3 * one);
  const Device delayed = with_delays(device, 0.5e-4, 0.0);
  double least = std::numeric_limits<double>::infinity();
  for (double stiffness = 1e4; stiffness < 1e9; stiffness *= 1.02) {
    DeviceParameters held = delayed.parameters();
    held.user = {0.0, 0.0, stiffness};
    least = std::min(least, critical_stiffness(Device(held)).stiffness);
  }
  EXPECT_GE(least, half);
  EXPECT_LT(least, half * 1.01);
}

// Above a bound it is not known.
TEST(TwoRates, AWallAboveABoundIsNotJudgedForAnyUser) {
  const Device device = with_delays(lhifam(1e-3, 1e-4, 100.0, 1e5), 0.5e-4, 0.0);
  const Analysis below = analyze(device);
  EXPECT_EQ(below.wall_stable_for->any_user, std::optional(true));
  DeviceParameters stiffer = device.parameters();
  stiffer.wall.stiffness = 1.01 * below.any_user->stiffness;
  const Analysis above = analyze(Device(stiffer));
  ASSERT_TRUE(above.wall_stable_for->nobody);
  EXPECT_FALSE(above.wall_stable_for->any_user.has_value());
  EXPECT_FALSE(std::ranges::any_of(above.remarks, [](const Remark& remark) {
    return remark.finding && remark.finding->code == FindingCode::stiffer_than_any_user_limit;
  }));
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

TEST(TwoRates, UncertainTimesOfEitherLoop) {
  DeviceParameters parameters = lhifam(1e-3, 1e-4, 100.0, 1e4).parameters();
  parameters.uncertainty = Uncertainty{.parameters = {"loop.sampling_period", "loop.damper.delay", "body.handle.mass"},
                                       .covariance = {{1e-10, 0.0, 0.0}, {0.0, 1e-12, 0.0}, {0.0, 0.0, 0.01}}};
  const Device device(parameters);
  EXPECT_EQ(with_one_rate(device).parameters().uncertainty->parameters,
            (std::vector<std::string>{"loop.sampling_period", "body.handle.mass"}));
  const Uncertainty of_damper = *with_loop_of_damper(device).parameters().uncertainty;
  EXPECT_EQ(of_damper.parameters, (std::vector<std::string>{"loop.delay", "body.handle.mass"}));
  EXPECT_EQ(of_damper.covariance, (std::vector<std::vector<double>>{{1e-12, 0.0}, {0.0, 0.01}}));
  const Analysis analysis = analyze(device, {.draws = 100});
  ASSERT_TRUE(analysis.interval.has_value());
  EXPECT_LT(analysis.interval->lower, analysis.critical.stiffness);
  EXPECT_GT(analysis.interval->upper, analysis.critical.stiffness);
  EXPECT_TRUE(analysis.limits.nobody.critical_damping.has_value());
}

TEST(TwoRates, WhatKnowsOneRateAloneRefuses) {
  const Device device = lhifam(1e-3, 1e-4, 100.0, 1e5);
  EXPECT_THROW((void)filtered_plant(device), Error);
  EXPECT_THROW((void)virtual_damper(device), Error);
  EXPECT_THROW((void)absolute_stability_limit(device, {}), Error);
}

}  // namespace
}  // namespace zwidth
