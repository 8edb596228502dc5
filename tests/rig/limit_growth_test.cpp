// An oscillation that grows is told from one that does not by what its growth rate may be off.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "campaign.hpp"
#include "rig/rig_actions.hpp"
#include "rig/rig_devices.hpp"
#include "rig/simulated_driver.hpp"
#include "zwidth/rig/wall_verdict.hpp"

namespace zwidth::rig {
namespace {

/// Rings at walls of 2.9 to 3.3 N m/rad with a decay of 0.002 to 0.01 1/s, far below its limit of 5.856 N m/rad.
Device marginal_device() {
  DeviceParameters parameters;
  parameters.motion = Motion::rotary;
  parameters.bodies = {{"motor", 1.7520246e-4, 5.18763e-4, 0.0, 0.0},
                       {"handle", 2.78560816e-5, 1.28764896e-5, 0.0, 0.0}};
  parameters.links = {{0, 1, 0.697622438, 1.59582234e-4}};
  parameters.loop.held = 1;
  parameters.loop.sampling_period = 0.5e-3;
  parameters.sensor.resolution = 2.37064484e-5;
  return Device(parameters);
}

bool has(const Trust& trust, FindingCode code) {
  return std::ranges::any_of(trust.findings, [&](const Finding& each) { return each.code == code; });
}

// 2.93 N m/rad was called sound: a rate of 0.013 +- 0.006 1/s that the encoder's step made counted as growth.
TEST(LimitGrowth, WhatTheEncoderMakesOfItIsNoGrowth) {
  const Device device = marginal_device();
  const double truth = critical_stiffness(device).stiffness;
  int sound = 0;
  for (double start = 2.0; start < 3.4; start += 0.1) {
    SCOPED_TRACE(start);
    SimulatedDriver driver{device, 0.0, false};
    LimitOptions limit = default_limit(device);
    limit.search.start = start;
    const RigLimit result = measure_limit(device, driver, {}, limit, {});
    ASSERT_TRUE(result.measured.stiffness);
    EXPECT_NEAR(*result.measured.stiffness / truth, 1.0, 0.02);
    if (result.measured.trust.sound()) ++sound;
    const bool is_untold = std::ranges::any_of(result.measured.trials, [&](const LimitTrial& trial) {
      return trial.ring && trial.stiffness < 4.0 && !trial.surely_grows() && !trial.surely_decays();
    });
    EXPECT_EQ(has(result.measured.trust, FindingCode::growth_not_told), is_untold);
    if (is_untold && result.measured.interval) {
      EXPECT_LT(result.measured.interval->lower, 3.3);
    }
  }
  EXPECT_LE(sound, 14);
}

/// The limit of a bench device with a random encoder, measured as its file without friction promises. `friction`: of the force.
struct MeasuredLimit {
  double truth = 0.0;  ///< without friction
  LimitMeasurement measured;
};
MeasuredLimit limit_of(std::uint64_t seed, double friction) {
  DeviceParameters parameters = test::bench_device(seed).parameters();
  const double truth = critical_stiffness(Device(parameters)).stiffness;
  const double force = default_force(Device(parameters));
  std::mt19937_64 engine(seed + 1000);
  const double share = std::exp(std::uniform_real_distribution(std::log(1e-4), std::log(0.1))(engine));
  parameters.sensor.resolution = share * force / truth;
  parameters.bodies[0].coulomb = friction * force;
  const Device device(parameters);
  SimulatedDriver driver{device, 0.0, false};
  return {truth, measure_limit(device, driver, {}, default_limit(device), {}).measured};
}

TEST(LimitGrowth, NoneOfRandomDevicesIsSoundAndWrong) {
  const std::uint64_t devices = test::by_tier(40U, 300U);
  std::uint64_t sound = 0;
  for (std::uint64_t seed = 1; seed <= devices; ++seed) {
    SCOPED_TRACE(seed);
    const auto [truth, measured] = limit_of(seed, 0.0);
    if (!measured.trust.sound()) continue;
    ++sound;
    ASSERT_TRUE(measured.stiffness);
    EXPECT_NEAR(*measured.stiffness / truth, 1.0, 0.02);
  }
  EXPECT_GT(sound, devices / 2);
}

// Friction of 0.05 to 5 % of the force holds back an oscillation above the limit that the device has without it.
TEST(LimitGrowth, NoneThatRubsIsSoundAndWrong) {
  for (std::uint64_t seed = 1; seed <= test::by_tier(10U, 100U); ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 engine(seed + 2000);
    const double friction = std::exp(std::uniform_real_distribution(std::log(5e-4), std::log(5e-2))(engine));
    const auto [truth, measured] = limit_of(seed, friction);
    if (!measured.trust.sound()) continue;
    ASSERT_TRUE(measured.stiffness);
    EXPECT_NEAR(*measured.stiffness / truth, 1.0, 0.02) << friction;
  }
}

/// Positions of an oscillation of 5 Hz at 1 kHz with this growth rate, as an encoder of 1e-3 of its swing tells them.
std::vector<double> ringing(double growth) {
  std::vector<double> positions;
  for (int k = 0; k < 8000; ++k) {
    const double time = 1e-3 * k;
    const double position = std::exp(growth * time) * std::sin(2.0 * std::numbers::pi * 5.0 * time);
    positions.push_back(1e-3 * std::round(1e3 * position));
  }
  return positions;
}

LimitSearch search_with(const std::vector<std::pair<double, double>>& growth_at) {
  LimitSearch search({.start = 1.0, .ceiling = 10.0, .frequencies = {2.0 * std::numbers::pi * 5.0}, .floor = 1e-3});
  for (const auto& [stiffness, growth] : growth_at) search.add(stiffness, ringing(growth), 1e-3, false);
  return search;
}

// Without a wall that surely decays nothing below the limit is told, and nothing was said.
TEST(LimitGrowth, IsUntoldWhereNoWallSurelyDecays) {
  const Device device = test::bench_device(1);
  const LimitMeasurement untold = search_with({{1.0, -1e-5}, {1.1, -1e-5}, {2.0, 0.2}}).measurement(device);
  ASSERT_FALSE(untold.trials[0].surely_decays());
  ASSERT_FALSE(untold.trials[0].surely_grows());
  ASSERT_TRUE(untold.trials[2].surely_grows());
  EXPECT_TRUE(has(untold.trust, FindingCode::growth_not_told));
  ASSERT_TRUE(untold.interval);
  EXPECT_EQ(untold.interval->lower, 0.0);
  const LimitMeasurement told = search_with({{1.0, -0.2}, {1.99, -0.002}, {2.0, 0.2}}).measurement(device);
  EXPECT_FALSE(has(told.trust, FindingCode::growth_not_told));
}

RigLimit measured_as(double stiffness, double promised) {
  RigLimit limit;
  limit.measured.stiffness = stiffness;
  limit.limits.nobody.critical_stiffness = promised;
  return limit;
}

// A limit 35 % below the file's promise stood without a word, where no upper bound was read.
TEST(LimitGrowth, ALimitThatIsNotThatOfTheFileIsSaidWithBothNumbers) {
  const Device device = marginal_device();
  for (const auto& [stiffness, code] :
       {std::pair(3.8, FindingCode::measured_below_promise), std::pair(8.0, FindingCode::measured_above_promise)}) {
    RigLimit limit = measured_as(stiffness, 5.86);
    judge(limit, device);
    ASSERT_EQ(limit.remarks.size(), 1U);
    ASSERT_TRUE(limit.remarks.front().finding);
    const Finding& finding = *limit.remarks.front().finding;
    EXPECT_EQ(finding.code, code);
    ASSERT_EQ(finding.evidence.size(), 3U);
    EXPECT_DOUBLE_EQ(finding.evidence[0].value, stiffness);
    EXPECT_DOUBLE_EQ(finding.evidence[1].value, 5.86);
  }
  RigLimit near = measured_as(5.5, 5.86);
  judge(near, device);
  EXPECT_TRUE(near.remarks.empty());
}

// Of a share p of the cycles the force is a period older.
TEST(LimitGrowth, UnansweredCyclesAreSaidWithWhatTheyDo) {
  const Device device = test::bench_device(1);
  RigSession session;
  session.timing.cycles = 1000;
  session.timing.unanswered = 48;
  remark(session, device);
  ASSERT_EQ(session.remarks.size(), 1U);
  const Finding finding = session.remarks.front().finding.value();
  EXPECT_EQ(finding.code, FindingCode::cycles_unanswered);
  ASSERT_EQ(finding.evidence.size(), 2U);
  EXPECT_DOUBLE_EQ(finding.evidence[0].value, 0.048);
  EXPECT_NEAR(finding.evidence[1].value, 0.088, 0.01);  // 0.048 T beside T/2
  RigLimit limit = measured_as(5.8, 5.86);
  limit.session = session;
  judge(limit, device);
  EXPECT_TRUE(has(limit.trust, FindingCode::cycles_unanswered));
  session = {};
  session.timing.cycles = 1000;
  remark(session, device);
  EXPECT_TRUE(session.remarks.empty());
}

TEST(LimitGrowth, ADriveThatLimitsForceBelowTheRigIsSaid) {
  RigSession session;
  session.limits.force = 20.0;
  session.drive.force_limit = 8.0;
  remark(session, test::bench_device(1));
  ASSERT_EQ(session.remarks.size(), 1U);
  EXPECT_EQ(session.remarks.front().finding.value().code, FindingCode::drive_limits_force);
  session.remarks.clear();
  session.drive.force_limit = 20.0;
  remark(session, test::bench_device(1));
  EXPECT_TRUE(session.remarks.empty());
}

// An AS5600 has steps of 1.53 mrad: a swing of 1 mrad was none.
TEST(DefaultForce, MovesTheDeviceByTwentyStepsOfItsEncoder) {
  DeviceParameters parameters = test::bench_device(1).parameters();
  const double fine = default_force(Device(parameters));
  parameters.sensor.resolution = 1.53e-3;
  const Device coarse(parameters);
  EXPECT_NEAR(default_force(coarse), 20.0 * 1.53e-3 * critical_stiffness(coarse).stiffness, 1e-9);
  EXPECT_GT(default_force(coarse), 20.0 * fine);
  EXPECT_DOUBLE_EQ(default_force(coarse, 1e-3), 1e-3 / 3.0) << "within the force limit";
}

}  // namespace
}  // namespace zwidth::rig
