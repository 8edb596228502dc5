// The region of stable walls of devices whose damper runs in a loop of its own.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "lhifam.hpp"
#include "reference/two_rate_devices.hpp"
#include "stability/limit/two_rate_stiffness.hpp"
#include "zwidth/design/region.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/damper_timing.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_damping.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

using internal::TwoRateDevice;

const RegionOptions walls_alone{.outline = {}, .any_user = false, .approximations = false, .progress = {}};

DeviceParameters lhifam_with_damper_at(double spring_period, double damper_period) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.sampling_period = spring_period;
  parameters.loop.damper = LoopDamper{damper_period, 0.0};
  return parameters;
}

double first_limit_at(const StableWalls& walls, double damping) {
  const std::vector<StableInterval> intervals = walls.stable_stiffnesses(damping);
  return intervals.empty() || intervals.front().lower > 0.0 ? 0.0 : intervals.front().upper.value();
}

// Of the loop as it runs, the pole nearest to the unit circle.
double nearest_to_circle(const Device& device, double stiffness, double damping) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& pole : TwoRateDevice(device, damping).as_it_runs(device).poles_minus_one(stiffness)) {
    least = std::min(least, std::abs(std::abs(1.0 + pole) - 1.0));
  }
  return least;
}

// docs/theory.md, "Two rates".
TEST(TwoRateRegion, OfLhifamHasItsLimits) {
  const WallRegion fast = region(Device(lhifam_with_damper_at(1e-3, 1e-4)), walls_alone);
  ASSERT_EQ(fast.status, WallRegion::Status::bounded);
  EXPECT_TRUE(fast.trust.sound());
  EXPECT_NEAR(fast.region.critical_stiffness, 8848.7087, 1e-4);
  EXPECT_NEAR(first_limit_at(*fast.walls, 100.0), 252107.311, 1e-3);
  EXPECT_NEAR(first_limit_at(*fast.walls, 200.0), 500666.043, 1e-3);
  const WallRegion slow = region(Device(lhifam_with_damper_at(1e-4, 1e-3)), walls_alone);
  ASSERT_EQ(slow.status, WallRegion::Status::bounded);
  EXPECT_NEAR(slow.region.critical_stiffness, 309679.688, 1e-3);
  EXPECT_NEAR(first_limit_at(*slow.walls, 100.0), 456719.274, 1e-3);
  // The damper alone has its own rate.
  const WallRegion one = region(Device(test::lhifam_parameters()), walls_alone);
  EXPECT_NEAR(slow.region.most_damped->damping / one.region.most_damped->damping, 1.0, 1e-9);
}

// A pole of the damper's loop that hardly anything of a held force reaches: the boundary runs along one B from K = 0 to beyond
// the region.
TEST(TwoRateRegion, MayEndAlongOneDamping) {
  DeviceParameters parameters;
  parameters.name = "late spring";
  parameters.bodies = {{"body", 2.778e-3, 2.047e-3, 0.0, 0.0}};
  parameters.loop = {0, 0, 0, 2.5e-3, 8.75e-3};
  parameters.loop.damper = LoopDamper{2.5e-3 / 8.0, 2.5e-3 / 8.0};
  const WallRegion found = region(Device(parameters), walls_alone);
  ASSERT_EQ(found.status, WallRegion::Status::bounded);
  const double most = found.region.most_damped->damping;
  for (const double share : {0.5, 0.999}) {
    parameters.wall.damping = share * most;
    const double limit = critical_stiffness(Device(parameters)).stiffness;
    EXPECT_GT(limit, 0.0);
    EXPECT_NEAR(first_limit_at(*found.walls, share * most), limit, 1e-9 * limit);
  }
  parameters.wall.damping = 1.001 * most;
  EXPECT_EQ(critical_stiffness(Device(parameters)).status, StiffnessStatus::none_stable);
}

// Between two slices in which no wall is stable: an island at twenty times the stiffness of the rest.
TEST(TwoRateRegion, HasWhatLiesFarFromTheRest) {
  DeviceParameters parameters;
  parameters.name = "three bodies";
  parameters.bodies = {
      {"a", 5.8183, 1.6802, 0.0, 0.0}, {"b", 2.8515, 2.7494, 0.0, 0.0}, {"c", 9.0434, 15.2487, 0.0, 0.0}};
  parameters.links = {{0, 1, 20647.32, 18.2518}, {1, 2, 69501.81, 8.4571}};
  parameters.loop.held = 2;
  parameters.loop.sampling_period = 3.4912e-5;
  parameters.loop.damper = LoopDamper{8.0 * 3.4912e-5, 2.93371e-4};
  const Device device(parameters);
  const WallRegion found = region(device, walls_alone);
  ASSERT_EQ(found.status, WallRegion::Status::bounded);
  EXPECT_TRUE(found.trust.sound());
  const std::vector<StableInterval> intervals = found.walls->stable_stiffnesses(18128.9);
  ASSERT_EQ(intervals.size(), 1U);
  EXPECT_NEAR(intervals.front().lower, 664e6, 3e6);
  EXPECT_NEAR(*intervals.front().upper, 672e6, 3e6);
  for (const double end : {intervals.front().lower, *intervals.front().upper}) {
    EXPECT_LT(nearest_to_circle(device, end, 18128.9), 1e-8);
  }
}

// Hardly anything of a fast force reaches a sensor behind the link: the usual gain is 10^10 times that of the boundary.
TEST(TwoRateRegion, OfASensorBehindTheLinkIsFound) {
  DeviceParameters parameters;
  parameters.name = "sensor behind the link";
  parameters.bodies = {{"motor", 0.05, 0.5, 0.0, 0.0}, {"handle", 0.11, 0.13, 0.0, 0.0}};
  parameters.links = {{0, 1, 2300.0, 0.77}};
  parameters.loop.sensed = 1;
  parameters.loop.sampling_period = 2.9e-4;
  parameters.loop.delay = 2.9e-4;
  parameters.loop.damper = LoopDamper{2.9e-4 / 8.0, 1.5e-5};
  parameters.actuator.time_constant = 1.7e-3;
  parameters.wall.velocity_filter_hz = 27.0;
  const WallRegion found = region(Device(parameters), walls_alone);
  ASSERT_EQ(found.status, WallRegion::Status::bounded);
  parameters.wall.damping = 1.2;
  const CriticalStiffness critical = critical_stiffness(Device(parameters));
  EXPECT_GT(critical.stiffness, 100.0);
  EXPECT_NEAR(first_limit_at(*found.walls, 1.2), critical.stiffness, 1e-6 * critical.stiffness);
}

TEST(TwoRateRegion, OfEqualRatesIsThatOfOneBitForBit) {
  const WallRegion apart = region(Device(lhifam_with_damper_at(1e-3, 1e-3)));
  const WallRegion together = region(Device(test::lhifam_parameters()));
  EXPECT_EQ(apart.region.area, together.region.area);
  EXPECT_EQ(apart.region.stiffest->stiffness, together.region.stiffest->stiffness);
  EXPECT_EQ(apart.any_user->area, together.any_user->area);
  ASSERT_EQ(apart.region.components.size(), together.region.components.size());
  const auto& first = apart.region.components.front().outline.arcs;
  const auto& second = together.region.components.front().outline.arcs;
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].points.size(), second[i].points.size());
    for (std::size_t j = 0; j < first[i].points.size(); ++j) {
      EXPECT_EQ(first[i].points[j].stiffness, second[i].points[j].stiffness);
      EXPECT_EQ(first[i].points[j].damping, second[i].points[j].damping);
    }
  }
}

// Its plant by the aliases of the damper's rate, with one step of it, against that of one rate.
TEST(TwoRateRegion, OfDelaysThatDifferByNothingComesNearToOneRate) {
  DeviceParameters parameters = lhifam_with_damper_at(1e-3, 1e-3);
  parameters.loop.delay = 2e-4;
  parameters.loop.damper->delay = 2e-4 * (1.0 + 1e-12);
  const WallRegion apart = region(Device(parameters), walls_alone);
  parameters.loop.damper.reset();
  const WallRegion together = region(Device(parameters), walls_alone);
  EXPECT_NEAR(apart.region.stiffest->stiffness / together.region.stiffest->stiffness, 1.0, 1e-8);
  EXPECT_NEAR(apart.region.area / together.region.area, 1.0, 1e-3);
  for (const double damping : {1.0, 20.0, 150.0}) {
    EXPECT_NEAR(first_limit_at(*apart.walls, damping) / first_limit_at(*together.walls, damping), 1.0, 1e-9);
  }
}

// Walls beside and beyond the outline, and points of it, against the poles of the loop as it runs, which know no plant of two
// rates.
TEST(TwoRateRegion, OfTheReferenceDevicesAgreesWithTheLoopAsItRuns) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> share(0.0, 1.2);
  for (const auto& each : test::two_rate_cases()) {
    const DeviceParameters parameters = test::two_rate_parameters(each);
    SCOPED_TRACE(parameters.name);
    const Device device(parameters);
    const WallRegion found = region(device, walls_alone);
    ASSERT_EQ(found.status, WallRegion::Status::bounded);
    EXPECT_TRUE(found.trust.sound());
    const double limit = first_limit_at(*found.walls, parameters.wall.damping);
    const double reference = each.at("critical_stiffness");
    EXPECT_NEAR(limit, reference, 1e-9 * reference);
    int told = 0;
    for (int i = 0; i < 100; ++i) {
      const double bend = i % 2 == 0 ? 1.0 : 0.1;
      const double stiffness = bend * share(random) * found.region.stiffest->stiffness;
      const double damping = bend * share(random) * found.region.most_damped->damping;
      const std::optional<int> outside = TwoRateDevice(device, damping).as_it_runs(device).unstable_poles(stiffness);
      if (!outside) continue;
      ++told;
      const std::vector<StableInterval> intervals = found.walls->stable_stiffnesses(damping);
      const bool inside = std::ranges::any_of(intervals, [&](const StableInterval& interval) {
        return stiffness > interval.lower && stiffness < interval.upper.value();
      });
      EXPECT_EQ(inside, *outside == 0) << stiffness << ", " << damping;
    }
    EXPECT_GT(told, 90);
    for (const StableComponent& component : found.region.components) {
      for (const BoundaryArc& arc : component.outline.arcs) {
        if (arc.kind == BoundaryKind::no_stiffness || arc.kind == BoundaryKind::no_damping) continue;
        // Ends are corners, where two poles may meet: an eigenvalue has half its digits there.
        for (std::size_t i = 3; i + 3 < arc.points.size(); i += 7) {
          const BoundaryPoint& point = arc.points[i];
          EXPECT_LT(nearest_to_circle(device, point.stiffness, point.damping), 1e-8)
              << point.stiffness << ", " << point.damping;
        }
      }
    }
  }
}

// A pole at -1 of a damper that runs twice a period: a held force does not reach it, whatever K.
TEST(TwoRateRegion, EndsAtALineThatNoSpringMoves) {
  DeviceParameters parameters;
  parameters.bodies = {{"stage", 1.0, 0.0, 0.0, 0.0}};
  parameters.loop.sampling_period = 2e-3;
  parameters.loop.damper = LoopDamper{1e-3, 0.0};
  const WallRegion found = region(Device(parameters), walls_alone);
  ASSERT_EQ(found.status, WallRegion::Status::bounded);
  EXPECT_TRUE(found.trust.sound());
  EXPECT_NEAR(found.region.most_damped->damping, 2.0 * 1.0 / 1e-3, 1e-6);
  const Device device(parameters);
  for (const double share : {0.05, 0.2}) {
    const auto told = [&](double damping) {
      const double stiffness = share * found.region.stiffest->stiffness;
      return TwoRateDevice(device, damping).as_it_runs(device).unstable_poles(stiffness);
    };
    EXPECT_NE(told(2001.0).value(), 0);
  }
}

// Where no user destabilises: the points are the limits of analyze(), and the polygon lies near those between them.
TEST(TwoRateRegion, OfAnyUserFollowsTheLimitOfAnalyze) {
  for (const double delay : {0.0, 0.4e-4}) {
    DeviceParameters parameters = lhifam_with_damper_at(1e-3, 1e-4);
    parameters.loop.delay = delay;
    parameters.loop.damper->delay = 0.0;
    const WallRegion found = region(Device(parameters));
    EXPECT_TRUE(found.trust.sound());
    EXPECT_TRUE(found.approximations.empty());
    ASSERT_TRUE(found.any_user.has_value());
    EXPECT_EQ(found.any_user->is_bound, delay > 0.0);
    ASSERT_EQ(found.any_user->ranges.size(), 1U);
    const std::vector<AbsoluteStabilityPoint>& points = found.any_user->ranges.front();
    const auto limit_at = [&](double damping) {
      parameters.wall.damping = damping;
      return analyze(Device(parameters), {.critical_damping = false}).any_user->stiffness;
    };
    const double extent = found.any_user->stiffest->stiffness;
    for (std::size_t i = 0; i + 2 < points.size(); i += 9) {
      EXPECT_NEAR(points[i].stiffness / limit_at(points[i].damping), 1.0, 1e-6) << points[i].damping;
      const double width = (points[i + 1].damping - points[i].damping) / found.any_user->most_damped->damping;
      if (width <= AbsoluteStabilityRegionOptions{}.deviation) continue;  // near in B
      const double between = 0.5 * (points[i].stiffness + points[i + 1].stiffness);
      EXPECT_NEAR(between, limit_at(0.5 * (points[i].damping + points[i + 1].damping)), 1.1e-3 * extent);
    }
    // A spring without a damper runs at its own rate; a damper without a spring at its own.
    EXPECT_EQ(points.front().stiffness, absolute_stability_limit(with_one_rate(Device(parameters))).stiffness);
    const double largest = absolute_stability_damping(with_loop_of_damper(Device(parameters))).damping;
    EXPECT_NEAR(found.any_user->most_damped->damping, largest, 1e-5 * largest);
  }
}

// Springs, masses and dampers at the handle, random but for their seed, leave every wall of that region stable.
TEST(TwoRateRegion, NoUserDestabilisesAWallOfAnyUser) {
  const DeviceParameters parameters = lhifam_with_damper_at(1e-3, 1e-4);
  const WallRegion found = region(Device(parameters));
  std::mt19937_64 random(11);
  const auto value = [&](double low, double high) {
    return std::pow(10.0, std::uniform_real_distribution(low, high)(random));
  };
  for (const auto& range : found.any_user->ranges) {
    for (std::size_t i = 1; i + 1 < range.size(); i += 5) {
      DeviceParameters held = parameters;
      held.wall.damping = range[i].damping;
      held.user = {value(-3.0, 2.0), value(-3.0, 3.0), value(1.0, 7.0)};
      EXPECT_GE(critical_stiffness(Device(held)).stiffness, range[i].stiffness * (1.0 - 1e-6)) << range[i].damping;
    }
  }
}

TEST(TwoRateRegion, OfASlowDamperLeavesUsersOutAndSaysSo) {
  const WallRegion found = region(Device(lhifam_with_damper_at(1e-4, 1e-3)));
  EXPECT_FALSE(found.any_user.has_value());
  EXPECT_TRUE(found.approximations.empty());
  const Device device(lhifam_with_damper_at(1e-4, 1e-3));
  EXPECT_THROW((void)absolute_stability_region(device, *found.walls, 100.0), Error);
  EXPECT_TRUE(std::ranges::any_of(found.remarks, [](const Remark& remark) {
    return remark.finding && remark.finding->code == FindingCode::left_out_beside_damper_loop;
  }));
}

}  // namespace
}  // namespace zwidth
