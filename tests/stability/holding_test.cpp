// Who holds the device: limits and verdicts with nobody, the file's user and any passive user.

#include "zwidth/stability/holding.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lhifam.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

/// A knob whose user damps it: 14.2 N m/rad with nobody holding, ten times as much in that hand.
DeviceParameters knob() {
  DeviceParameters device;
  device.name = "knob";
  device.motion = Motion::rotary;
  device.bodies = {{"knob", 2e-3, 7.1e-3, 0.0, 0.0}};
  device.loop = {0, 0, 0, 1e-3, 0.0};
  device.user = {0.0, 6.5e-2, 0.0};
  return device;
}

double excess(const DeviceParameters& parameters, double stiffness) {
  const Device device(parameters);
  Wall wall = parameters.wall;
  wall.stiffness = stiffness;
  return stability_excess(sample(state_space(device), {parameters.loop.sampling_period, parameters.loop.delay}), wall);
}

TEST(Holding, AWallIsJudgedForAll) {
  EXPECT_EQ(stability_of({true, std::nullopt, true}), WallStability::anyone);
  EXPECT_EQ(stability_of({true, true, true}), WallStability::anyone);
  EXPECT_EQ(stability_of({true, std::nullopt, false}), WallStability::alone_only);
  EXPECT_EQ(stability_of({true, std::nullopt, std::nullopt}), WallStability::alone_only);
  EXPECT_EQ(stability_of({true, true, false}), WallStability::alone_only);
  EXPECT_EQ(stability_of({false, true, false}), WallStability::unstable);
  EXPECT_EQ(stability_of({true, false, false}), WallStability::unstable);
  EXPECT_EQ(stability_of({false, std::nullopt, std::nullopt}), WallStability::unstable);
}

TEST(Holding, NamesAreThoseOfEveryFront) {
  EXPECT_EQ(words_of(Holder::nobody), "nobody holding");
  EXPECT_EQ(words_of(Holder::user), "the file's user");
  EXPECT_EQ(words_of(Holder::any_user), "any passive user");
  EXPECT_EQ(words_of(WallStability::anyone), "stable for anyone");
  EXPECT_EQ(words_of(WallStability::alone_only), "stable alone only");
  EXPECT_EQ(words_of(WallStability::unstable), "unstable");
}

// The limit with the user was given as the device's, and a wall that shakes once the user lets go as stable.
TEST(Holding, AKnobInAHandIsJudgedWithoutIt) {
  DeviceParameters parameters = knob();
  parameters.wall.stiffness = 40.0;
  const Analysis analysis = analyze(Device(parameters));
  EXPECT_TRUE(analysis.trust.sound());
  EXPECT_NEAR(analysis.limits.nobody.critical_stiffness, 14.2, 0.05);
  ASSERT_TRUE(analysis.limits.user);
  EXPECT_GT(analysis.limits.user->critical_stiffness, 100.0);
  EXPECT_EQ(analysis.limits.user->critical_stiffness, analysis.critical.stiffness);
  for (const bool held : {false, true}) {
    DeviceParameters each = parameters;
    if (!held) each.user = {};
    const HolderLimit& limit = held ? *analysis.limits.user : analysis.limits.nobody;
    EXPECT_LT(excess(each, 0.9999 * limit.critical_stiffness), 0.0);
    EXPECT_GT(excess(each, 1.0001 * limit.critical_stiffness), 0.0);
  }
  ASSERT_TRUE(analysis.wall_stable_for);
  EXPECT_FALSE(analysis.wall_stable_for->nobody);
  EXPECT_EQ(analysis.wall_stable_for->user, true);
  EXPECT_EQ(analysis.wall_stable_for->any_user, false);
  EXPECT_EQ(verdict_on_wall(analysis), WallVerdict::unstable);
  ASSERT_TRUE(analysis.alone);
  ASSERT_TRUE(analysis.alone->wall);
  EXPECT_GT(analysis.alone->wall->spectral_radius, 1.0);
  EXPECT_LT(analysis.wall->spectral_radius, 1.0);
}

TEST(Holding, TheLimitsAreThoseOfTheDeviceWithoutTheUser) {
  const DeviceParameters parameters = knob();
  const HoldingLimits limits = holding_limits(Device(parameters));
  const HoldingLimits alone = holding_limits(device_without_user(Device(parameters)));
  EXPECT_EQ(limits.nobody.critical_stiffness, alone.nobody.critical_stiffness);
  EXPECT_EQ(limits.nobody.critical_damping, alone.nobody.critical_damping);
  EXPECT_EQ(limits.any_user->critical_stiffness, alone.any_user->critical_stiffness);
  EXPECT_FALSE(alone.user);
  // Colgate and Schenkel: 2 b/T, and b of a damper.
  EXPECT_NEAR(limits.any_user->critical_stiffness, 14.2, 1e-6);
  EXPECT_NEAR(*limits.any_user->critical_damping, 7.1e-3, 1e-8);
  EXPECT_LE(limits.any_user->critical_stiffness, limits.nobody.critical_stiffness);
  EXPECT_LE(limits.any_user->critical_stiffness, limits.user->critical_stiffness);
}

TEST(Holding, WallsBetweenTheLimitsAreStableAloneOnly) {
  DeviceParameters parameters = test::lhifam_parameters();
  const std::pair<double, WallStability> walls[] = {
      {5000.0, WallStability::anyone}, {7000.0, WallStability::alone_only}, {9000.0, WallStability::unstable}};
  for (const auto& [stiffness, expected] : walls) {
    parameters.wall.stiffness = stiffness;
    const Analysis analysis = analyze(Device(parameters));
    ASSERT_TRUE(analysis.wall_stable_for);
    EXPECT_EQ(stability_of(*analysis.wall_stable_for), expected) << stiffness;
    EXPECT_FALSE(analysis.wall_stable_for->user);
    EXPECT_FALSE(analysis.alone);
  }
}

TEST(Holding, ADamperAloneIsAWall) {
  DeviceParameters parameters;
  parameters.motion = Motion::rotary;
  parameters.bodies = {{"rotor", 0.05, 0.01, 0.0, 0.0}};
  parameters.loop = {0, 0, 0, 1e-3, 0.0};
  parameters.wall.stiffness = 0.0;
  parameters.wall.damping = 0.5;
  const Analysis free = analyze(Device(parameters));
  EXPECT_TRUE(free.trust.sound());
  EXPECT_EQ(verdict_on_wall(free), WallVerdict::stable);
  EXPECT_EQ(stability_of(*free.wall_stable_for), WallStability::alone_only);  // B > b: some user
  EXPECT_LT(free.wall->spectral_radius, 1.0);
  EXPECT_TRUE(free.wall->gain_margin);
  parameters.wall.damping = 0.009;
  EXPECT_EQ(stability_of(*analyze(Device(parameters)).wall_stable_for), WallStability::anyone);
  parameters.bodies = {{"rotor", 2e-6, 2e-5, 0.0, 0.0}};
  parameters.loop.delay = 1e-3;
  parameters.wall.damping = 0.006;
  const Analysis shaking = analyze(Device(parameters));
  EXPECT_TRUE(shaking.trust.sound());
  EXPECT_EQ(verdict_on_wall(shaking), WallVerdict::unstable);
  EXPECT_NEAR(shaking.wall->spectral_radius, 1.569, 5e-4);
  ASSERT_TRUE(shaking.limits.nobody.critical_damping);
  EXPECT_LT(*shaking.limits.nobody.critical_damping, 0.006);
  ASSERT_TRUE(shaking.limits.nobody.damping_limited_by);
  EXPECT_EQ(shaking.limits.nobody.damping_limited_by->kind, Oscillator::Kind::rigid_body);
}

}  // namespace
}  // namespace zwidth
