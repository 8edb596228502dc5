#include "zwidth/design/absolute_stability_region.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "lhifam.hpp"
#include "zwidth/design/region.hpp"
#include "zwidth/design/region_approximation.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

// Any passive user of a rigid device without delay: exactly Colgate & Schenkel, b > K T/2 + B (1 - a)/(1 + a).
TEST(AbsoluteStabilityRegion, OfARigidDeviceIsColgatesTriangle) {
  for (const double filter : {0.0, 100.0}) {
    const Device device(test::rigid_parameters());
    const AbsoluteStabilityRegion region =
        absolute_stability_region(device, StableWalls(filtered_plant(device), filter), 1000.0);
    const double factor = filter > 0.0 ? std::tanh(std::numbers::pi * filter * 1e-3) : 1.0;
    ASSERT_EQ(region.ranges.size(), 1U);
    for (const AbsoluteStabilityPoint& point : region.ranges[0]) {
      EXPECT_NEAR(point.stiffness, 2.0 * (3.5 - point.damping * factor) / 1e-3, 7000.0 * 1e-5) << point.damping;
    }
    EXPECT_NEAR(region.most_damped->damping, 3.5 / factor, 1e-5);
    EXPECT_NEAR(region.area, 0.5 * 7000.0 * 3.5 / factor, 1e-4 * 7000.0 * 3.5);
  }
}

// Theory, section 5.
TEST(AbsoluteStabilityRegion, BeginsAtTheLimitWithoutADamper) {
  const Device device(test::lhifam_parameters());
  const AbsoluteStabilityRegion region = absolute_stability_region(device, StableWalls(filtered_plant(device)), 600.0);
  EXPECT_NEAR(region.ranges.at(0).front().stiffness / 5776.09, 1.0, 1e-5);
}

TEST(AbsoluteStabilityRegion, LiesWithinTheStableWalls) {
  const Device device(test::with_delay(test::lhifam_parameters(), 0.25e-3));
  const StableWalls walls(filtered_plant(device));
  const AbsoluteStabilityRegion region = absolute_stability_region(device, StableWalls(filtered_plant(device)), 400.0);
  ASSERT_FALSE(region.ranges.empty());
  for (const auto& range : region.ranges) {
    for (const AbsoluteStabilityPoint& point : range) {
      const auto intervals = walls.stable_stiffnesses(point.damping);
      ASSERT_FALSE(intervals.empty()) << point.damping;
      EXPECT_LE(point.stiffness, *intervals.front().upper * (1.0 + 1e-6)) << point.damping;
    }
  }
}

TEST(AbsoluteStabilityRegion, RefusesWhatHasNoRange) {
  const Device device(test::rigid_parameters());
  for (const double largest : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW((void)absolute_stability_region(device, StableWalls(filtered_plant(device)), largest), Error);
  }
  EXPECT_THROW((void)absolute_stability_region(device, StableWalls(filtered_plant(device)), 1.0, {0.0}), Error);
  const Device transfer(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1.0));
  EXPECT_THROW((void)absolute_stability_region(transfer, StableWalls(filtered_plant(transfer)), 1.0), Error);
}

// The held body is tied to the wall's by a weak damper only: no user moves the loop, and a limit of nobody that is not
// shown to hold is none. Beyond 5.9e4 N/m no wall is stable at all.
TEST(AbsoluteStabilityRegion, LiesWithinTheStableWallsOfAWeaklyTiedUser) {
  DeviceParameters device;
  device.bodies = {{"b0", 0.8325734374746622, 0.32389258228824686, 0.0, 0.0},
                   {"b1", 6.908418820718172, 0.32858414479667364, 0.0, 0.0},
                   {"b2", 0.07795901412675403, 1.5772366610712838, 0.0, 0.0}};
  device.links = {{0, 1, 0.0, 0.051315604819899586}, {1, 2, 378.64746905163133, 1.281660530301486}};
  device.loop = {0, 0, 2, 0.0031209502786166987, 0.0};
  const AbsoluteStabilityRegion region =
      absolute_stability_region(Device(device), StableWalls(filtered_plant(Device(device))), 534.0389020487077);
  ASSERT_TRUE(region.stiffest);
  EXPECT_NEAR(region.stiffest->stiffness, 58822.0, 100.0);
  EXPECT_TRUE(region.trust.sound());
}

// Soft links: at the end of the region every wall has a pole on the circle, and a limit at that very B was 175 times
// that of the stiffest stable wall.
TEST(AbsoluteStabilityRegion, IsNeverLargerThanThatOfNobody) {
  DeviceParameters device;
  device.bodies = {{"b0", 0.33749731851186165, 0.0, 0.0, 0.0},
                   {"b1", 0.42213375107505585, 0.022688329379610496, 0.0, 0.0},
                   {"b2", 2.937738044810607, 0.0, 0.0, 0.0},
                   {"b3", 0.2149249768759708, 0.046686650336620006, 0.0, 0.0}};
  device.links = {{0, 1, 0.3622017848412191, 0.004731977308795342},
                  {1, 2, 1.8492917945690677, 0.2422143237335779},
                  {2, 3, 1.4474502873108066, 0.0017194060637776472}};
  device.loop = {0, 0, 3, 0.01, 0.02};
  const WallRegion walls = region(Device(device));
  ASSERT_TRUE(walls.any_user && walls.region.stiffest);
  EXPECT_LE(walls.any_user->stiffest->stiffness, walls.region.stiffest->stiffness);
  EXPECT_LE(walls.any_user->area, walls.region.area);
  EXPECT_LE(walls.any_user->most_damped->damping, walls.region.most_damped->damping);
}

}  // namespace
}  // namespace zwidth
