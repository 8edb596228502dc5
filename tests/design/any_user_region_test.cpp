#include "zwidth/design/any_user_region.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "lhifam.hpp"
#include "zwidth/design/region_approximation.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

// Any passive user of a rigid device without delay: exactly Colgate & Schenkel, b > K T/2 + B (1 - a)/(1 + a).
TEST(AnyUserRegion, OfARigidDeviceIsColgatesTriangle) {
  for (const double filter : {0.0, 100.0}) {
    const Device device(test::rigid_parameters());
    const AnyUserRegion region = any_user_region(device, filter, 1000.0);
    const double factor = filter > 0.0 ? std::tanh(std::numbers::pi * filter * 1e-3) : 1.0;
    ASSERT_EQ(region.ranges.size(), 1U);
    for (const AnyUserPoint& point : region.ranges[0]) {
      EXPECT_NEAR(point.stiffness, 2.0 * (3.5 - point.damping * factor) / 1e-3, 7000.0 * 1e-5) << point.damping;
    }
    EXPECT_NEAR(region.most_damped->damping, 3.5 / factor, 1e-5);
    EXPECT_NEAR(region.area, 0.5 * 7000.0 * 3.5 / factor, 1e-4 * 7000.0 * 3.5);
  }
}

// Theory, section 5.
TEST(AnyUserRegion, BeginsAtTheLimitWithoutADamper) {
  const AnyUserRegion region = any_user_region(Device(test::lhifam_parameters()), 0.0, 600.0);
  EXPECT_NEAR(region.ranges.at(0).front().stiffness / 5776.09, 1.0, 1e-5);
}

TEST(AnyUserRegion, LiesWithinTheStableWalls) {
  const Device device(test::with_delay(test::lhifam_parameters(), 0.25e-3));
  const StableWalls walls(filtered_plant(device));
  const AnyUserRegion region = any_user_region(device, 0.0, 400.0);
  ASSERT_FALSE(region.ranges.empty());
  for (const auto& range : region.ranges) {
    for (const AnyUserPoint& point : range) {
      const auto intervals = walls.stable_stiffnesses(point.damping);
      ASSERT_FALSE(intervals.empty()) << point.damping;
      EXPECT_LE(point.stiffness, *intervals.front().upper * (1.0 + 1e-6)) << point.damping;
    }
  }
}

TEST(AnyUserRegion, RefusesWhatHasNoRange) {
  const Device device(test::rigid_parameters());
  for (const double largest : {0.0, -1.0, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW((void)any_user_region(device, 0.0, largest), Error);
  }
  EXPECT_THROW((void)any_user_region(device, 0.0, 1.0, {0.0}), Error);
  const Device transfer(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1.0));
  EXPECT_THROW((void)any_user_region(transfer, 0.0, 1.0), Error);
}

}  // namespace
}  // namespace zwidth
