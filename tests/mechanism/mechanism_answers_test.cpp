// A device of a mechanism in the computations that take one, each against another: the planar arm, along x.
#include <gtest/gtest.h>

#include <algorithm>
#include <complex>
#include <cstddef>
#include <vector>

#include "zwidth/design/notch_design.hpp"
#include "zwidth/design/region.hpp"
#include "zwidth/error.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/simulation/simulate.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"

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

// The direction that the wall leaves free is a pole at z = 1, which rounding puts outside the circle or not.
TEST(MechanismAnswers, ASimulationSettlesBelowTheLimitAndGrowsAbove) {
  for (const double share : {0.05, 0.3, 0.6, 0.8, 0.95, 0.97}) {
    SCOPED_TRACE(share);
    const Device device = arm(share * 318.881897);
    EXPECT_EQ(simulate(device).verdict, LoopVerdict::settles);
    EXPECT_LT(wall_margins(device).spectral_radius, 1.0 - 1e-6);
  }
  EXPECT_EQ(simulate(arm(1.1 * 318.881897)).verdict, LoopVerdict::unstable);
}

bool remarks_of(const Simulation& simulation, FindingCode code, const std::vector<Evidence>& evidence) {
  return std::ranges::any_of(simulation.remarks, [&](const Remark& each) {
    return each.finding && each.finding->code == code && each.finding->evidence == evidence;
  });
}

TEST(MechanismAnswers, ASimulationSaysThatItIsLinearisedAndWithoutFriction) {
  const Simulation plain = simulate(arm(200.0));
  EXPECT_TRUE(remarks_of(plain, FindingCode::motion_linearised, {}));
  DeviceParameters rubbing = arm(200.0).parameters();
  const std::size_t n = rubbing.coordinates->size();
  std::vector<double> along(n, 0.0);
  along[0] = 1.0;
  rubbing.coordinates->frictions = {{along, 0.02}, {along, 0.3}};
  const Simulation with = simulate(Device(rubbing));
  EXPECT_TRUE(remarks_of(with, FindingCode::friction_left_out, {{"rubbing", 2.0}, {"largest", 0.3}}));
  EXPECT_EQ(with.final_position, plain.final_position);
}

// An arm that nothing damps where the wall leaves it free: two poles at z = 1, neither of the wall's doing.
TEST(MechanismAnswers, WhatTheWallLeavesFreeAndUndampedIsNoPole) {
  DeviceParameters loose = arm(100.0).parameters();
  Coordinates& of = *loose.coordinates;
  const std::size_t n = of.size();
  // One more coordinate that nothing holds, seen nowhere, moved with the others by its mass and pushed.
  std::vector<double> mass((n + 1) * (n + 1), 0.0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) mass[i * (n + 1) + j] = of.mass[i * n + j];
  }
  mass.back() = 0.01;
  of.mass = mass;
  for (Coordinates::Element& each : of.elements) each.weights.push_back(0.0);
  for (Coordinates::Point& each : of.points) each.weights.push_back(each.name == "motors" ? 0.1 : 0.0);
  of.tip.reset();
  loose.mechanism.reset();
  const Device device(loose);
  EXPECT_NEAR(critical_stiffness(device).stiffness / 318.881897, 1.0, 1e-8);
  const WallMargins margins = wall_margins(device);
  EXPECT_TRUE(margins.stable);
  EXPECT_LT(margins.spectral_radius, 1.0 - 1e-6);
  EXPECT_NEAR(margins.spectral_radius / wall_margins(arm(100.0)).spectral_radius, 1.0, 1e-9);
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
