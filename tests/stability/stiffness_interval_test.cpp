#include "zwidth/stability/stiffness_interval.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "stability/device_draws.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
namespace {

DeviceParameters with_uncertainty(DeviceParameters device, std::vector<std::string> keys,
                                  std::vector<std::vector<double>> covariance) {
  device.uncertainty = Uncertainty{std::move(keys), std::move(covariance)};
  return device;
}

double critical(DeviceParameters device) {
  device.uncertainty.reset();
  return critical_stiffness(Device(std::move(device))).stiffness;
}

double slope(const DeviceParameters& device, const std::string& key) {
  const double value = *parameter(device, key);
  const double step = 1e-4 * value;
  DeviceParameters above = device;
  DeviceParameters below = device;
  set_parameter(above, key, value + step);
  set_parameter(below, key, value - step);
  return (critical(above) - critical(below)) / (2.0 * step);
}

// Small uncertainties: K_CR is linear in the parameters, so its standard deviation is that of the gradient (delta
// method), covariance included. 4000 draws know a 2.5 % quantile to 0.042 standard deviations (one sigma).
TEST(StiffnessInterval, IsThatOfTheDeltaMethodForSmallUncertainty) {
  const std::vector<std::string> keys{"body.motor.damping", "body.handle.damping", "link.0.stiffness"};
  const std::vector<std::vector<double>> covariance{{1e-6, 2.4e-5, 0.0}, {2.4e-5, 1.156e-3, -3.0}, {0.0, -3.0, 6.32e4}};
  const DeviceParameters device = with_uncertainty(test::lhifam_parameters(), keys, covariance);
  double variance = 0.0;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    for (std::size_t j = 0; j < keys.size(); ++j) {
      variance += slope(device, keys[i]) * covariance[i][j] * slope(device, keys[j]);
    }
  }
  const double deviation = std::sqrt(variance);
  const StiffnessInterval interval = stiffness_interval(Device(device), 4000);
  const double centre = critical(device);
  EXPECT_NEAR(interval.lower, centre - 1.96 * deviation, 4.0 * 0.042 * deviation);
  EXPECT_NEAR(interval.upper, centre + 1.96 * deviation, 4.0 * 0.042 * deviation);
  EXPECT_EQ(interval.other_mechanism, 0.0);
  EXPECT_EQ(interval.draws, 4000U);
}

// The exact K_CR = b²(1-a)/(m(1-a) - a b T) of a rigid device rises with b: its quantiles are those of b, however wide.
TEST(StiffnessInterval, FollowsAMonotonicFunctionExactly) {
  const DeviceParameters device = with_uncertainty(test::rigid_parameters(), {"body.body.damping"}, {{1.0}});
  const StiffnessInterval interval = stiffness_interval(Device(device), 4000);
  const auto with_damping = [](double damping) {
    DeviceParameters other = test::rigid_parameters();
    other.bodies[0].damping = damping;
    return critical(other);
  };
  EXPECT_GT(interval.lower, with_damping(3.5 - 1.96 - 0.17));
  EXPECT_LT(interval.lower, with_damping(3.5 - 1.96 + 0.17));
  EXPECT_GT(interval.upper, with_damping(3.5 + 1.96 - 0.17));
  EXPECT_LT(interval.upper, with_damping(3.5 + 1.96 + 0.17));
}

// Where the limit passes from one branch to another a gradient sees only one of them: here more link damping than the
// nominal one changes nothing any more (the rigid body limits), less of it lets the mode limit.
TEST(StiffnessInterval, HoldsWhereTheLimitingBranchSwitches) {
  DeviceParameters device = test::lhifam_parameters();
  const auto limited_by_mode = [&](double damping) {
    device.links[0].damping = damping;
    return critical_stiffness(Device(device)).limit->limited_by.kind == Oscillator::Kind::vibration_mode;
  };
  double low = 0.1;  // limited by the mode
  double high = 15.0;
  ASSERT_TRUE(limited_by_mode(low));
  while (high - low > 1e-6) (limited_by_mode(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
  ASSERT_FALSE(limited_by_mode(high));
  const double at_switch = critical(device);
  const StiffnessInterval interval =
      stiffness_interval(Device(with_uncertainty(device, {"link.0.damping"}, {{0.01 * high * high}})), 2000);
  EXPECT_GT(interval.other_mechanism, 0.4);
  EXPECT_LT(interval.other_mechanism, 0.6);
  EXPECT_LT(interval.lower, 0.95 * at_switch);
  EXPECT_GT(interval.upper, 0.95 * at_switch);
}

TEST(StiffnessInterval, TheVirtualDamperStaysClosed) {
  DeviceParameters device = with_uncertainty(test::lhifam_parameters(), {"body.handle.damping"}, {{1e-8}});
  device.wall.damping = 5.0;
  device.wall.velocity_filter_hz = 50.0;
  const StiffnessInterval interval = stiffness_interval(Device(device), 40);
  EXPECT_NEAR(interval.lower, critical(device), 1.0);
}

TEST(StiffnessInterval, IsReproducible) {
  const Device device(with_uncertainty(test::lhifam_parameters(), {"link.0.damping"}, {{4.0}}));
  const StiffnessInterval once = stiffness_interval(device, 200, 7);
  const StiffnessInterval again = stiffness_interval(device, 200, 7);
  const StiffnessInterval other = stiffness_interval(device, 200, 8);
  EXPECT_EQ(once.lower, again.lower);
  EXPECT_EQ(once.upper, again.upper);
  EXPECT_NE(once.lower, other.lower);
}

// Two parameters that always move together: the covariance is singular, its square root exists all the same.
TEST(StiffnessInterval, TakesASemidefiniteCovariance) {
  const DeviceParameters device = with_uncertainty(
      test::lhifam_parameters(), {"body.motor.damping", "body.handle.damping"}, {{1e-4, 1e-4}, {1e-4, 1e-4}});
  const StiffnessInterval interval = stiffness_interval(Device(device), 1000);
  const double deviation = 0.01 * (slope(device, "body.motor.damping") + slope(device, "body.handle.damping"));
  EXPECT_NEAR(interval.upper - interval.lower, 2.0 * 1.96 * deviation, 0.15 * deviation * 4.0);
}

TEST(StiffnessInterval, WithoutSpreadItIsAPoint) {
  const DeviceParameters device = with_uncertainty(test::lhifam_parameters(), {"link.0.damping"}, {{0.0}});
  const StiffnessInterval interval = stiffness_interval(Device(device), 50);
  EXPECT_DOUBLE_EQ(interval.lower, critical(device));
  EXPECT_DOUBLE_EQ(interval.upper, critical(device));
}

// Draws that the kernel of many devices takes, and others: the quantiles are those of every draw by itself.
TEST(StiffnessInterval, IsThatOfEveryDrawAlone) {
  constexpr std::size_t draws = 600;
  const std::uint64_t seed = 20261123;
  test::RandomDevices random(seed);
  for (const char* kind : {"rigid", "two_mass", "user_side", "fractional_delay", "light_damping", "filtered_damper",
                           "actuator_lag", "grounded", "three_mass", "wall_filter"}) {
    DeviceParameters parameters = random.device(kind);
    std::vector<std::string> keys;
    std::vector<std::vector<double>> covariance;
    for (const Body& body : parameters.bodies) keys.push_back("body." + body.name + ".damping");
    keys.emplace_back("loop.delay");
    for (std::size_t i = 0; i < keys.size(); ++i) {
      covariance.emplace_back(keys.size(), 0.0);
      covariance[i][i] = std::pow(0.1 * *parameter(parameters, keys[i]), 2);
    }
    const Device device(with_uncertainty(parameters, keys, covariance));
    const StiffnessInterval interval = stiffness_interval(device, draws, seed);
    internal::DeviceDraws drawn(device, seed);
    const CriticalStiffness own = critical_stiffness(device);
    std::vector<double> stiffness;
    std::size_t others = 0;
    for (std::size_t i = 0; i < draws; ++i) {
      const CriticalStiffness one = critical_stiffness(drawn.next());
      stiffness.push_back(one.stiffness);
      const bool is_same = one.status == own.status && one.limit.has_value() == own.limit.has_value() &&
                           (!own.limit || one.limit->limited_by.mode == own.limit->limited_by.mode);
      others += is_same ? 0U : 1U;
    }
    std::ranges::sort(stiffness);
    const double lower = std::min(stiffness[draws / 40], own.stiffness);
    const double upper = std::max(stiffness[draws - 1 - draws / 40], own.stiffness);
    EXPECT_NEAR(interval.lower, lower, 1e-12 * lower) << kind;
    EXPECT_NEAR(interval.upper, upper, 1e-12 * upper) << kind;
    EXPECT_EQ(interval.other_mechanism, static_cast<double>(others) / draws) << kind;
  }
}

// A filter of 0 Hz is none, and a link of no stiffness no link: draws stay off what is another device.
TEST(StiffnessInterval, DrawsReachZeroWhereSmallValuesComeToIt) {
  DeviceParameters device = test::lhifam_parameters();
  device.wall.damping = 5.0;
  device.wall.velocity_filter_hz = 100.0;
  device.user = {.mass = 0.1, .damping = 1.0, .stiffness = 1.0};
  for (const auto& [key, least_share] :
       {std::pair{"wall.velocity_filter_hz", 0.01}, std::pair{"link.0.stiffness", 0.01},
        std::pair{"body.motor.mass", 0.01}, std::pair{"operator.mass", 0.0}, std::pair{"wall.damping", 0.0},
        std::pair{"loop.delay", 0.0}}) {
    device.loop.delay = 1e-4;
    const double mean = *parameter(device, key);
    const Device uncertain(with_uncertainty(device, {key}, {{mean * mean}}));
    internal::DeviceDraws drawn(uncertain, 1);
    double least = mean;
    for (int i = 0; i < 100; ++i) least = std::min(least, *parameter(drawn.next().parameters(), key));
    EXPECT_NEAR(least, least_share * mean, 1e-12 * mean) << key;
  }
}

// Of two bodies on a stiff link the response shows the sum of the dampings, not how they share it: where one would
// become negative, the other keeps the sum.
TEST(StiffnessInterval, WhatIsKnownOfASumStaysKnownAtABound) {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies[0].damping = 0.0;
  device.bodies[1].damping = 3.5;
  device.links[0].stiffness *= 100.0;  // how they share it hardly matters
  const double open = 2.0 * 2.0;
  const StiffnessInterval interval = stiffness_interval(
      Device(with_uncertainty(device, {"body.motor.damping", "body.handle.damping"}, {{open, -open}, {-open, open}})),
      300);
  EXPECT_NEAR(interval.lower, critical(device), 0.05 * critical(device));
  EXPECT_NEAR(interval.upper, critical(device), 0.05 * critical(device));
}

// The delay is 0, and its draws go up alone, each with more damping: of those that stay at 0 the lower tail counts.
TEST(StiffnessInterval, ANumberAtItsBoundHidesNoTail) {
  DeviceParameters device = test::rigid_parameters();
  device.loop.delay = 0.0;
  const double deviation = 0.1 * device.bodies[0].damping;
  const double of_delay = 1e-6;
  constexpr double correlation = 0.7;
  const double both = correlation * deviation * of_delay;
  const StiffnessInterval interval =
      stiffness_interval(Device(with_uncertainty(device, {"body.body.damping", "loop.delay"},
                                                 {{deviation * deviation, both}, {both, of_delay * of_delay}})),
                         4000);
  const double with_delay_known = 1.96 * deviation * std::sqrt(1.0 - correlation * correlation);
  EXPECT_NEAR(interval.lower, critical(device) - slope(device, "body.body.damping") * with_delay_known,
              0.06 * with_delay_known * slope(device, "body.body.damping"));
}

// Impossible draws are brought to their bound: an uncertain damping near 0 stays a damping.
TEST(StiffnessInterval, DrawsStayPossible) {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies[0].damping = 0.01;
  device.loop.delay = 1e-5;
  const StiffnessInterval interval = stiffness_interval(
      Device(with_uncertainty(device, {"body.motor.damping", "loop.delay"}, {{1.0, 0.0}, {0.0, 1e-8}})), 300);
  EXPECT_GT(interval.lower, 0.0);
  EXPECT_TRUE(std::isfinite(interval.upper));
}

// A mass without damping is unstable behind the softest wall, whatever the mass.
TEST(StiffnessInterval, DrawsWithoutAStableWallCountAsZero) {
  DeviceParameters device = test::rigid_parameters();
  device.bodies[0].damping = 0.0;
  const StiffnessInterval interval =
      stiffness_interval(Device(with_uncertainty(device, {"body.body.mass"}, {{0.01}})), 100);
  EXPECT_EQ(interval.lower, 0.0);
  EXPECT_EQ(interval.upper, 0.0);
}

TEST(StiffnessInterval, RefusesWithoutUncertaintyOrDraws) {
  EXPECT_THROW((void)stiffness_interval(Device(test::lhifam_parameters())), Error);
  const Device device(with_uncertainty(test::lhifam_parameters(), {"link.0.damping"}, {{4.0}}));
  EXPECT_THROW((void)stiffness_interval(device, 0), Error);
}

// Of one number the limit rises with, the quantiles are the limits at its own.
TEST(AbsoluteStabilityInterval, FollowsAMonotonicFunction) {
  DeviceParameters parameters = test::lhifam_parameters();
  constexpr double variance = 0.04;
  parameters.uncertainty = Uncertainty{{"body.handle.damping"}, {{variance}}};
  const StiffnessInterval interval = absolute_stability_interval(Device(parameters), {}, 400);
  const auto limit_at = [&](double deviations) {
    DeviceParameters moved = parameters;
    moved.uncertainty.reset();
    moved.bodies[1].damping += deviations * std::sqrt(variance);
    return absolute_stability_limit(Device(moved)).stiffness;
  };
  EXPECT_GT(interval.lower, limit_at(-2.4));
  EXPECT_LT(interval.lower, limit_at(-1.6));
  EXPECT_GT(interval.upper, limit_at(1.6));
  EXPECT_LT(interval.upper, limit_at(2.4));
  EXPECT_EQ(interval.draws, 400U);
}

TEST(AbsoluteStabilityInterval, RefusesWithoutUncertaintyOrDraws) {
  DeviceParameters parameters = test::lhifam_parameters();
  EXPECT_THROW((void)absolute_stability_interval(Device(parameters)), Error);
  parameters.uncertainty = Uncertainty{{"body.handle.damping"}, {{0.04}}};
  EXPECT_THROW((void)absolute_stability_interval(Device(parameters), {}, 0), Error);
}

// 8 kN/m with an interval from 7.6: was called stable, and some devices that the uncertainty allows are not.
TEST(StiffnessInterval, AWallWithinItIsNotSurelyStable) {
  DeviceParameters parameters = with_uncertainty(test::lhifam_parameters(), {"body.handle.damping"}, {{0.04}});
  parameters.wall.stiffness = 8000.0;
  const Analysis within = analyze(Device(parameters));
  ASSERT_TRUE(within.interval && within.wall && within.wall->stable);
  ASSERT_LT(within.interval->lower, 8000.0);
  EXPECT_EQ(within.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_EQ(verdict_on_wall(within), WallVerdict::unsure);
  EXPECT_TRUE(within.critical.trust.sound()) << "the limit is known as well as it is";
  parameters.wall.stiffness = 7000.0;
  const Analysis below = analyze(Device(parameters));
  EXPECT_EQ(verdict_on_wall(below), WallVerdict::stable);
  ASSERT_TRUE(below.any_user && below.any_user->interval);
  EXPECT_LT(below.any_user->interval->lower, below.any_user->stiffness);
}

TEST(StiffnessInterval, AnalysisHasItWhereTheDeviceHasAnUncertainty) {
  EXPECT_FALSE(analyze(Device(test::lhifam_parameters())).interval.has_value());
  const Device device(with_uncertainty(test::lhifam_parameters(), {"link.0.damping"}, {{1.0}}));
  const Analysis analysis = analyze(device);
  ASSERT_TRUE(analysis.interval.has_value());
  EXPECT_EQ(analysis.interval->lower, stiffness_interval(device).lower);
  EXPECT_LT(analysis.interval->lower, analysis.critical.stiffness);
  EXPECT_GT(analysis.interval->upper, analysis.critical.stiffness);
}

}  // namespace
}  // namespace zwidth
