// The walls of the first lines, beside the functions that give more of them.

#include "zwidth/design/wall_summary.hpp"

#include <gtest/gtest.h>

#include <string>

#include "lhifam.hpp"
#include "zwidth/design/absolute_stability_region.hpp"
#include "zwidth/design/stable_walls.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_damping.hpp"

namespace zwidth {
namespace {

WallSummary summary_of(const Device& device) { return wall_summary(device, analyze(device)); }

// As far as the region is sampled nothing is stiffer, and the wall given is one of its own limits.
TEST(WallSummary, TheStiffestWallIsTheRegions) {
  const DeviceParameters lhifam = test::lhifam_parameters();
  for (const DeviceParameters& each : {lhifam, test::handle_sensed(lhifam), test::with_delay(lhifam, 1e-3)}) {
    const Device device(each);
    const WallSummary summary = summary_of(device);
    ASSERT_TRUE(summary.with_damper);
    EXPECT_FALSE(summary.why_no_damper);
    EXPECT_EQ(summary.with_damper->holder, Holder::any_user);
    EXPECT_EQ(absolute_stability_limit(device, {summary.with_damper->damping, 0.0}).stiffness,
              summary.with_damper->stiffness);
    const AbsoluteStabilityRegion region =
        absolute_stability_region(device, StableWalls(filtered_plant(device)), critical_damping(device).damping);
    ASSERT_TRUE(region.stiffest);
    EXPECT_GE(summary.with_damper->stiffness, region.stiffest->stiffness * (1.0 - 1e-4));
    EXPECT_LE(summary.with_damper->stiffness, region.stiffest->stiffness * 1.005);
  }
}

// b > K T/2 + B: no damper is better than any.
TEST(WallSummary, ARigidDeviceIsStiffestWithoutADamper) {
  const WallSummary summary = summary_of(Device(test::rigid_parameters()));
  ASSERT_TRUE(summary.with_damper);
  EXPECT_NEAR(summary.with_damper->stiffness, 7000.0, 0.01);
  EXPECT_EQ(summary.with_damper->damping, 0.0);
}

// With a damper on the drive: the stiffest of its own region, and the wall recommended there.
TEST(WallSummary, OfAFasterDamperIsThatOfTwoRates) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.damper = LoopDamper{1e-4, 0.0};
  const Device device(parameters);
  const WallSummary summary = summary_of(device);
  ASSERT_TRUE(summary.with_damper && summary.with_margins);
  parameters.wall.damping = summary.with_damper->damping;
  EXPECT_NEAR(analyze(Device(parameters)).any_user->stiffness / summary.with_damper->stiffness, 1.0, 1e-9);
  const auto region = absolute_stability_region(device, StableWalls(device), critical_damping(device).damping);
  EXPECT_GE(summary.with_damper->stiffness, region.stiffest->stiffness * (1.0 - 1e-4));
  EXPECT_LE(summary.with_damper->stiffness, region.stiffest->stiffness * 1.005);
  EXPECT_EQ(summary.with_margins->wall.stiffness, recommend_wall(device).wall->wall.stiffness);
}

TEST(WallSummary, OfOtherTwoRatesIsLeftOut) {
  for (const LoopDamper& damper : {LoopDamper{2e-3, 0.0}, LoopDamper{1e-4, 0.3e-4}}) {
    DeviceParameters parameters = test::lhifam_parameters();
    parameters.loop.damper = damper;
    const WallSummary summary = summary_of(Device(parameters));
    EXPECT_FALSE(summary.with_damper || summary.with_margins);
    ASSERT_TRUE(summary.why_no_damper && summary.why_no_margins);
    EXPECT_EQ(summary.why_no_damper->code, FindingCode::left_out_beside_damper_loop);
    EXPECT_EQ(summary.why_no_margins->code, FindingCode::left_out_beside_damper_loop);
  }
}

TEST(WallSummary, TheWallWithMarginsIsTheRecommended) {
  const Device device(test::lhifam_parameters());
  const WallSummary summary = summary_of(device);
  const WallRecommendation whole = recommend_wall(device);
  ASSERT_TRUE(summary.with_margins);
  ASSERT_TRUE(whole.wall);
  EXPECT_EQ(summary.with_margins->wall.stiffness, whole.wall->wall.stiffness);
  EXPECT_EQ(summary.with_margins->wall.damping, whole.wall->wall.damping);
  EXPECT_EQ(summary.with_margins->wall.velocity_filter_hz, whole.wall->wall.velocity_filter_hz);
  EXPECT_GE(*summary.with_margins->margins.gain_margin, 2.0 * (1.0 - 1e-9));
  EXPECT_LE(*summary.with_margins->wall.stiffness, summary.with_damper->stiffness);
  EXPECT_TRUE(recommend_wall(device, {.alternatives = false}).alternatives.empty());
}

TEST(WallSummary, NobodyHoldsATransferFunction) {
  const WallSummary summary = summary_of(Device(test::transfer_function_parameters({1.0}, {1.0, 2.0, 0.0}, 1e-2)));
  ASSERT_TRUE(summary.with_damper);
  EXPECT_EQ(summary.with_damper->holder, Holder::nobody);
  EXPECT_GT(summary.with_damper->stiffness, 0.0);
}

TEST(WallSummary, ManyBodiesAreLeftOutWithAWord) {
  DeviceParameters chain = test::lhifam_parameters();
  for (std::size_t i = 2; i <= most_bodies_for_wall_summary; ++i) {
    chain.bodies.push_back({std::to_string(i), 0.2, 0.5, 0.0, 0.0});
    chain.links.push_back({i - 1, i, 2e4, 1.0});
  }
  const WallSummary summary = summary_of(Device(chain));
  EXPECT_FALSE(summary.with_damper);
  EXPECT_FALSE(summary.with_margins);
  ASSERT_TRUE(summary.why_no_damper);
  EXPECT_EQ(summary.why_no_damper->code, FindingCode::too_many_bodies_for_wall_summary);
  EXPECT_EQ(summary.why_no_margins, summary.why_no_damper);
}

}  // namespace
}  // namespace zwidth
