// What reaches a stiffness where the damper runs in a loop of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "lhifam.hpp"
#include "zwidth/design/design_target.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

Device with_drive_loop(double spring_period, double damper_period, double damping) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.sampling_period = spring_period;
  parameters.loop.damper = LoopDamper{damper_period, 1e-4};
  parameters.loop.delay = 1e-4;
  parameters.wall.damping = damping;
  return Device(parameters);
}

Device moved(const Device& device, const DesignTarget& target, double share) {
  DeviceParameters parameters = device.parameters();
  const double value = share * *target.value_needed;
  if (target.key == "loop.sampling_period") {
    *parameters.loop.damper->sampling_period *= value / parameters.loop.sampling_period;
  }
  set_parameter(parameters, target.key, value);
  return Device(std::move(parameters));
}

bool is_stable(const Device& device, double stiffness) {
  DeviceParameters parameters = device.parameters();
  parameters.wall.stiffness = stiffness;
  return wall_margins(Device(parameters)).stable;
}

bool has(const std::vector<Remark>& remarks, FindingCode code) {
  return std::ranges::any_of(remarks, [&](const Remark& each) { return each.finding && each.finding->code == code; });
}

TEST(TwoRateTarget, EveryNeededValueIsConfirmedByTheLoopAsItRuns) {
  for (const Device& device : {with_drive_loop(1e-3, 1e-4, 200.0), with_drive_loop(2e-4, 6e-4, 100.0)}) {
    const double target = 1.3 * critical_stiffness(device).stiffness;
    const DesignTargets found = design_targets(device, {.stiffness = target, .factor = 10.0});
    EXPECT_TRUE(has(found.remarks, FindingCode::damper_period_follows));
    int confirmed = 0;
    bool has_delay_of_damper = false;
    for (const DesignTarget& each : found.targets) {
      SCOPED_TRACE(each.key);
      has_delay_of_damper |= each.key == "loop.damper.delay";
      if (!each.value_needed || each.why.code == FindingCode::limit_jumps_across_target) continue;
      const Device there = moved(device, each, 1.0);
      EXPECT_NEAR(critical_stiffness(there).stiffness / target, 1.0, 1e-9);
      EXPECT_TRUE(is_stable(there, 0.999 * target));
      EXPECT_FALSE(is_stable(there, 1.001 * target));
      ++confirmed;
    }
    EXPECT_TRUE(has_delay_of_damper);
    EXPECT_GE(confirmed, 2);
  }
}

TEST(TwoRateTarget, OfAnyPassiveUser) {
  const Device device = with_drive_loop(1e-3, 1e-4, 200.0);
  const double now = analyze(device).any_user->stiffness;
  const double target = 1.2 * now;
  const DesignTargets found =
      design_targets(device, {.stiffness = target, .goal = StiffnessGoal::absolute_stability_limit, .factor = 10.0});
  EXPECT_NEAR(*found.limit_now, now, 1e-9 * now);
  int confirmed = 0;
  int left_out = 0;
  for (const DesignTarget& each : found.targets) {
    SCOPED_TRACE(each.key);
    if (each.key == "loop.delay" || each.key == "loop.damper.delay") {
      ++left_out;
      EXPECT_FALSE(each.value_needed.has_value());
      EXPECT_EQ(each.why.code, FindingCode::left_out_beside_damper_loop);
    }
    if (!each.value_needed || each.why.code == FindingCode::limit_jumps_across_target) continue;
    EXPECT_NEAR(analyze(moved(device, each, 1.0)).any_user->stiffness / target, 1.0, 1e-6);
    ++confirmed;
  }
  EXPECT_EQ(left_out, 2);
  EXPECT_GE(confirmed, 2);
}

// With delays that differ by a period of the damper, another period leaves the limit unknown: nothing is claimed of it.
TEST(TwoRateTarget, ClaimsNothingWhereTheLimitIsNotKnown) {
  DeviceParameters parameters = with_drive_loop(1e-3, 1e-4, 200.0).parameters();
  parameters.loop.delay = 0.0;
  const DesignTargets found = design_targets(
      Device(parameters), {.stiffness = 6e5, .goal = StiffnessGoal::absolute_stability_limit, .factor = 10.0});
  const auto period = std::ranges::find(found.targets, std::string("loop.sampling_period"), &DesignTarget::key);
  ASSERT_NE(period, found.targets.end());
  EXPECT_FALSE(period->value_needed.has_value());
  EXPECT_EQ(period->why.code, FindingCode::left_out_beside_damper_loop);
}

TEST(TwoRateTarget, OfAnyPassiveUserIsRefusedWhereTheirLimitIsNotKnown) {
  const DesignTargetOptions options{.stiffness = 1e5, .goal = StiffnessGoal::absolute_stability_limit};
  EXPECT_THROW(design_targets(with_drive_loop(1e-4, 1e-3, 100.0), options), Error);
}

}  // namespace
}  // namespace zwidth
