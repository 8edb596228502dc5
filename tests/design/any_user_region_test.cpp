#include "zwidth/design/any_user_region.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "lhifam.hpp"
#include "zwidth/design/region_approximation.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/any_user.hpp"

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

// The limits of this chain are shown to hold to some per mille only: the region is as doubtful as they are.
TEST(AnyUserRegion, IsAsDoubtfulAsItsLimits) {
  DeviceParameters device;
  device.bodies = {{"b0", 0.03431438631269368, 0.07394725824682534, 0.0, 0.0},
                   {"b1", 7.535880186559966, 0.0, 0.0, 0.0},
                   {"b2", 2.137837522572063, 0.0, 0.0, 0.0},
                   {"b3", 0.02332093646085895, 0.0, 0.0, 0.0}};
  device.links = {{0, 1, 7187.992899200791, 0.0}, {1, 2, 136156.3386349951, 0.0}, {1, 3, 154.3144575324455, 0.0}};
  device.loop = {0, 0, 2, 0.0009342718492376095, 0.0};
  EXPECT_EQ(any_user_limit(Device(device), {0.03, 0.0}).trust.verdict, Trust::Verdict::doubtful);
  const AnyUserRegion region = any_user_region(Device(device), 0.0, 66.0);
  EXPECT_EQ(region.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_TRUE(any_user_region(Device(test::lhifam_parameters()), 0.0, 600.0).trust.sound());
}

}  // namespace
}  // namespace zwidth
