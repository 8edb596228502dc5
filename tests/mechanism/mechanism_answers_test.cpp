// A device of a mechanism in the computations that take one, each against another: the planar arm, along x.
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>

#include "zwidth/design/notch_design.hpp"
#include "zwidth/design/region.hpp"
#include "zwidth/error.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/simulation/simulate.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

Device arm(double stiffness) {
  DeviceParameters parameters;
  parameters.mechanism.emplace();
  parameters.mechanism->mechanism.path = ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.xml";
  parameters.mechanism->mechanism.tip = "tip";
  parameters.mechanism->mechanism.pose = {{"shoulder", 0.3}, {"elbow", 1.2}};
  parameters.mechanism->normal = {1.0, 0.0, 0.0};
  parameters.loop.sampling_period = 1e-3;
  parameters.wall.stiffness = stiffness;
  return device_of_mechanism(parameters);
}

TEST(MechanismAnswers, ARegionEndsAtTheCriticalStiffness) {
  const WallRegion found = region(arm(0.0));
  EXPECT_EQ(found.status, WallRegion::Status::bounded);
  EXPECT_TRUE(found.trust.sound());
  EXPECT_NEAR(found.region.critical_stiffness / 318.881897, 1.0, 1e-8);
  ASSERT_TRUE(found.any_user);
  EXPECT_NEAR(found.any_user->ranges.front().front().stiffness / 278.845911, 1.0, 1e-5);  // at B = 0
  EXPECT_EQ(std::ranges::count_if(found.remarks,
                                  [](const Remark& each) {
                                    return each.finding && each.finding->code == FindingCode::any_grasp_scanned;
                                  }),
            1);
  ASSERT_TRUE(found.region.most_damped);
  ASSERT_TRUE(found.region.stiffest);
  EXPECT_GT(found.region.stiffest->stiffness, 318.9);  // a damper helps
}

// The arm is damped so little that no default run sees it come to rest.
TEST(MechanismAnswers, ASimulationGrowsAboveTheLimitAndNotBelow) {
  EXPECT_NE(simulate(arm(0.95 * 318.881897)).verdict, LoopVerdict::unstable);
  EXPECT_EQ(simulate(arm(1.1 * 318.881897)).verdict, LoopVerdict::unstable);
}

TEST(MechanismAnswers, WhatKnowsBodiesAloneRefusesByCode) {
  try {
    (void)design_notch(arm(100.0), {});
    ADD_FAILURE() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::needs_bodies);
  }
}

}  // namespace
}  // namespace zwidth
