// The device on the rig bears less than its file promises: a finding. And who holds it.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "rig/rig_actions.hpp"
#include "rig/rig_devices.hpp"
#include "rig/simulated_driver.hpp"
#include "zwidth/model/device_user.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth::rig {
namespace {

/// The limit of the device in `driver`, measured by whoever has the file of `device`.
RigLimit limit_of_other(const Device& device, const Device& in_driver) {
  SimulatedDriver driver{in_driver, 0.0, false};
  return measure_limit(device, driver, {}, default_limit(device), {});
}

/// The same device with its dampings, and so about its limit, times this.
Device damped_by(const Device& device, double factor) {
  DeviceParameters parameters = device.parameters();
  for (Body& body : parameters.bodies) body.damping *= factor;
  for (Link& link : parameters.links) link.damping *= factor;
  return Device(parameters);
}

bool says_unsafe(const RigLimit& limit) {
  return limit.remarks.size() == 1 && limit.remarks.front().severity == Remark::Severity::warning &&
         limit.remarks.front().finding && limit.remarks.front().finding->code == FindingCode::device_bears_less;
}

bool warns(const RigLimit& limit) {
  return std::ranges::any_of(limit.remarks,
                             [](const Remark& each) { return each.severity == Remark::Severity::warning; });
}

Device knob() {
  DeviceParameters device;
  device.name = "knob";
  device.motion = Motion::rotary;
  device.bodies = {{"knob", 2e-3, 7.1e-3, 0.0, 0.0}};
  device.loop = {0, 0, 0, 1e-3, 0.0};
  device.user = {0.0, 6.5e-2, 0.0};
  return Device(device);
}

class OfABenchDevice : public testing::TestWithParam<std::uint64_t> {
 protected:
  Device device = test::bench_device(GetParam());
};

// 35 % below the prediction stood without a word.
TEST_P(OfABenchDevice, ALimitFarBelowThePredictionIsUnsafe) {
  const RigLimit limit = limit_of_other(damped_by(device, 1.5), device);
  ASSERT_TRUE(limit.measured.stiffness && limit.measured.at_most);
  ASSERT_LT(*limit.measured.at_most, limit.predicted.stiffness);
  EXPECT_TRUE(says_unsafe(limit));
  EXPECT_TRUE(limit.measured.trust.sound());
  EXPECT_EQ(limit.predicted.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_EQ(limit.trust.verdict, Trust::Verdict::doubtful);
}

// The measurement's own interval decides, which is about a hundredth, not a percentage of ours.
TEST_P(OfABenchDevice, SoIsOneAFewPercentBelow) {
  const RigLimit limit = limit_of_other(damped_by(device, 1.05), device);
  ASSERT_GT(limit.predicted.stiffness, 1.03 * critical_stiffness(device).stiffness);
  EXPECT_TRUE(says_unsafe(limit));
}

TEST_P(OfABenchDevice, OneAsPredictedOrAboveIsNot) {
  for (const double factor : {1.0, 0.8}) {
    const RigLimit limit = limit_of_other(damped_by(device, factor), device);
    ASSERT_TRUE(limit.measured.at_most);
    EXPECT_FALSE(warns(limit));
    EXPECT_EQ(limit.trust, limit.measured.trust);
    EXPECT_GE(*limit.measured.at_most, critical_stiffness(device).stiffness);
  }
}

INSTANTIATE_TEST_SUITE_P(Bench, OfABenchDevice, testing::Range(std::uint64_t{1}, std::uint64_t{9}));

// Neither a coarse encoder nor friction of which the file knows nothing makes an alarm of a device that bears what it says.
TEST(UnsafeLimit, IsNoFalseAlarm) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    DeviceParameters parameters = test::bench_device(seed).parameters();
    const double truth = critical_stiffness(Device(parameters)).stiffness;
    std::mt19937_64 engine(seed);
    const double share = std::exp(std::uniform_real_distribution(std::log(1e-3), std::log(0.3))(engine));
    DeviceParameters coarse = parameters;
    coarse.sensor.resolution = share * default_force(Device(parameters)) / truth;
    EXPECT_FALSE(says_unsafe(limit_of_other(Device(coarse), Device(coarse))));
    DeviceParameters rough = parameters;
    rough.bodies.front().coulomb = 0.01 * default_force(Device(parameters));
    EXPECT_FALSE(warns(limit_of_other(Device(parameters), Device(rough))));
  }
}

TEST(UnsafeLimit, WhoHoldsIsKnownInTheFileAlone) {
  const Device device = knob();
  const RigLimit held = limit_of_other(device, device);
  EXPECT_TRUE(held.remarks.empty());
  ASSERT_TRUE(held.limits.user && held.limits.any_user);
  EXPECT_EQ(held.limits.user->critical_stiffness, held.predicted.stiffness);
  EXPECT_NEAR(held.limits.nobody.critical_stiffness, 14.2, 0.05);
  EXPECT_NEAR(*held.measured.stiffness / held.predicted.stiffness, 1.0, 0.02);
  // Nobody holds it: the file's limit for that is kept.
  const RigLimit free = limit_of_other(device, device_without_user(device));
  ASSERT_TRUE(free.measured.at_most);
  ASSERT_EQ(free.remarks.size(), 1U);
  EXPECT_EQ(free.remarks.front().severity, Remark::Severity::note);
  EXPECT_TRUE(free.predicted.trust.sound());
  // Nobody holds it, and it bears less than that too.
  const RigLimit less = limit_of_other(device, damped_by(device_without_user(device), 0.7));
  EXPECT_TRUE(says_unsafe(less)) << less.measured.at_most.value_or(0.0);
}

// A wall that shakes once the user lets go was predicted stable.
TEST(RigWallHeld, IsPredictedWithNobodyToo) {
  const Device device = knob();
  SimulatedDriver driver{device, 0.0, false};
  WallOptions wall;
  wall.controller.kind = ControllerOptions::Kind::wall;
  wall.controller.stiffness = 40.0;
  wall.duration = 0.5;
  const RigWall result = render_wall(device, driver, {}, wall);
  ASSERT_TRUE(result.stable_for);
  EXPECT_FALSE(result.stable_for->nobody);
  EXPECT_EQ(result.stable_for->user, true);
  EXPECT_EQ(result.stable_for->any_user, false);
  EXPECT_EQ(result.predicted_stable, false);
  EXPECT_EQ(result.trust.verdict, Trust::Verdict::doubtful);
  wall.controller.stiffness = 10.0;
  SimulatedDriver again{device, 0.0, false};
  const RigWall soft = render_wall(device, again, {}, wall);
  EXPECT_EQ(soft.predicted_stable, true);
  EXPECT_EQ(stability_of(*soft.stable_for), WallStability::anyone);
}

}  // namespace
}  // namespace zwidth::rig
