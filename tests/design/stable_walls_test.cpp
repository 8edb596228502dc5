#include "zwidth/design/stable_walls.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "lhifam.hpp"
#include "zwidth/design/stable_region.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

StableWalls walls_of(const DeviceParameters& device, double velocity_filter_hz = 0.0) {
  return StableWalls(filtered_plant(Device(device)), velocity_filter_hz);
}

DeviceParameters undamped_mass(double mass, double period) {
  DeviceParameters device;
  device.name = "mass";
  device.bodies = {{"body", mass, 0.0, 0.0, 0.0}};
  device.loop.sampling_period = period;
  return device;
}

// Jury's test of z³ + (k + β - 2) z² + (1 + k) z - β, k = K T²/(2m), β = B T/(2m), the closed loop of a mass:
// stable iff 0 < k < 2 β (1 - β)/(1 + β).
TEST(StableWalls, OfAMassAreThoseOfJurysTest) {
  constexpr double mass = 0.7;
  constexpr double period = 2e-3;
  const StableWalls walls = walls_of(undamped_mass(mass, period));
  for (const double beta : {1e-6, 1e-3, 0.1, 0.25, 0.5, 0.75, 0.9, 0.999}) {
    const auto intervals = walls.stable_stiffnesses(2.0 * mass / period * beta);
    ASSERT_EQ(intervals.size(), 1U) << beta;
    EXPECT_EQ(intervals[0].lower, 0.0);
    const double exact = 2.0 * mass / (period * period) * 2.0 * beta * (1.0 - beta) / (1.0 + beta);
    EXPECT_NEAR(*intervals[0].upper / exact, 1.0, 1e-11) << beta;
  }
  EXPECT_TRUE(walls.stable_stiffnesses(0.0).empty());
  EXPECT_TRUE(walls.stable_stiffnesses(2.0 * mass / period * (1.0 + 1e-9)).empty());
}

// The maximum of 2 β (1 - β)/(1 + β) is 2 (sqrt 2 - 1)² at β = sqrt 2 - 1; its integral over 0..1 is 3 - 4 ln 2.
TEST(StableRegion, OfAMassHasTheExtremesAndTheAreaOfItsClosedForm) {
  constexpr double mass = 0.7;
  constexpr double period = 2e-3;
  const StableRegion region = stable_region(walls_of(undamped_mass(mass, period)));
  const double beta = std::sqrt(2.0) - 1.0;
  const double stiffness = 2.0 * mass / (period * period);
  const double damping = 2.0 * mass / period;
  ASSERT_EQ(region.components.size(), 1U);
  EXPECT_NEAR(region.stiffest->stiffness / (stiffness * 2.0 * beta * beta), 1.0, 1e-12);
  EXPECT_NEAR(region.stiffest->damping / (damping * beta), 1.0, 1e-6);  // flat there
  EXPECT_NEAR(region.most_damped->damping / damping, 1.0, 1e-9);
  EXPECT_NEAR(region.area / (stiffness * damping * (3.0 - 4.0 * std::log(2.0))), 1.0, 1e-3);
  EXPECT_EQ(region.critical_stiffness, 0.0);
  EXPECT_TRUE(region.components[0].from_zero);
}

TEST(StableRegion, MeetsTheCriticalStiffnessAtZeroDamping) {
  const StableRegion region = stable_region(walls_of(test::lhifam_parameters()));
  EXPECT_NEAR(region.critical_stiffness / 8848.70869499712, 1.0, 1e-12);  // docs/theory.md, "The paper's errata", 1
}

TEST(StableRegion, OutlineIsClosedAndRunsCounterClockwise) {
  for (const double delay : {0.0, 0.25e-3, 8.25e-3}) {
    for (const double filter : {0.0, 100.0}) {
      const StableRegion region = stable_region(walls_of(test::with_delay(test::lhifam_parameters(), delay), filter));
      for (const StableComponent& component : region.components) {
        EXPECT_GT(component.area, 0.0);
        const auto& arcs = component.outline.arcs;
        for (std::size_t i = 0; i < arcs.size(); ++i) {
          const BoundaryPoint& end = arcs[i].points.back();
          const BoundaryPoint& begin = arcs[(i + 1) % arcs.size()].points.front();
          EXPECT_NEAR(end.stiffness, begin.stiffness, 1e-9 * region.stiffest->stiffness);
          EXPECT_NEAR(end.damping, begin.damping, 1e-9 * region.most_damped->damping);
          for (const BoundaryPoint& point : arcs[i].points) {
            EXPECT_GE(point.stiffness, 0.0);
            EXPECT_GE(point.damping, 0.0);
          }
        }
      }
    }
  }
}

TEST(StableRegion, ExtremesBoundEveryPoint) {
  const StableRegion region = stable_region(walls_of(test::with_delay(test::lhifam_parameters(), 1e-3), 50.0));
  for (const BoundaryArc& arc : region.components.at(0).outline.arcs) {
    for (const BoundaryPoint& point : arc.points) {
      EXPECT_LE(point.stiffness, region.stiffest->stiffness);
      EXPECT_LE(point.damping, region.most_damped->damping);
    }
  }
}

// The polygon of a coarse and of a fine outline differ by the stated deviation only.
TEST(StableRegion, AreaConvergesWithTheOutline) {
  const StableWalls walls = walls_of(test::lhifam_parameters());
  const double fine = stable_region(walls, {1e-6}).area;
  EXPECT_NEAR(stable_region(walls, {1e-2}).area / fine, 1.0, 1e-2);
  EXPECT_NEAR(stable_region(walls).area / fine, 1.0, 1e-3);
}

// With 300 samples of delay the curve turns 150 times; all but the stable corner is ruled out beforehand.
TEST(StableWalls, OfALoopWithALongDelayAreFoundAsFast) {
  const FilteredPlant plant = filtered_plant(Device(test::with_delay(test::lhifam_parameters(), 0.3)));
  const StableWalls walls(plant);
  const StableRegion region = stable_region(walls);
  ASSERT_EQ(region.components.size(), 1U);
  for (const double share : {0.0, 0.2, 0.5, 0.9, 1.1}) {
    const double damping = share * region.most_damped->damping;
    const auto ours = walls.stable_stiffnesses(damping);
    const auto exact = critical_stiffness(plant, {damping, 0.0}).stable_intervals;
    ASSERT_EQ(ours.size(), exact.size()) << share;
    for (std::size_t i = 0; i < ours.size(); ++i) {
      EXPECT_NEAR(*ours[i].upper / *exact[i].upper, 1.0, 1e-9) << share;
    }
  }
}

TEST(StableWalls, OfAPlantThatIsNotSeenAreAll) {
  SampledPlant nothing;
  nothing.period = 1e-3;
  const StableWalls walls(filtered_plant(nothing, {}));
  const auto intervals = walls.stable_stiffnesses(3.0);
  ASSERT_EQ(intervals.size(), 1U);
  EXPECT_FALSE(intervals[0].upper.has_value());
  const StableRegion region = stable_region(walls);
  EXPECT_FALSE(region.bounded);
  EXPECT_TRUE(region.components.empty());
}

// 1/(s - 1) needs K > 1 in continuous time; sampled, a pole passes z = 1 at K = -1/P(1) = 1.
TEST(StableRegion, OfAnUnstablePlantBeginsWhereAPolePassesRest) {
  const StableRegion region = stable_region(walls_of(test::transfer_function_parameters({1.0}, {1.0, -1.0}, 0.1)));
  ASSERT_EQ(region.components.size(), 1U);
  EXPECT_FALSE(region.components[0].from_zero);
  EXPECT_EQ(region.critical_stiffness, 0.0);
  bool drifts = false;
  for (const BoundaryArc& arc : region.components[0].outline.arcs) {
    if (arc.kind != BoundaryKind::drift) continue;
    drifts = true;
    for (const BoundaryPoint& point : arc.points) EXPECT_NEAR(point.stiffness, 1.0, 1e-12);
  }
  EXPECT_TRUE(drifts);
}

// A first-order plant e^{-T} = q without damper: one pole q - K (1 - q), stable for -1 < . < 1 (Nyquist first).
TEST(StableRegion, OfAFirstOrderPlantEndsAtNyquist) {
  const StableRegion region = stable_region(walls_of(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1.0)));
  EXPECT_NEAR(region.critical_stiffness, 2.16395341373865, 1e-12);  // of 1/(s + 1), T = 1 s: (e + 1)/(e - 1)
  bool nyquist = false;
  for (const BoundaryArc& arc : region.components.at(0).outline.arcs) nyquist |= arc.kind == BoundaryKind::nyquist;
  EXPECT_TRUE(nyquist);
}

TEST(StableOnGrid, IsTheIntervalsOfEachRow) {
  const StableWalls walls = walls_of(test::lhifam_parameters(), 100.0);
  std::vector<double> stiffnesses{-5.0, 0.0};
  std::vector<double> dampings;
  for (int i = 1; i <= 40; ++i) stiffnesses.push_back(2000.0 * i);
  for (int i = 0; i <= 40; ++i) dampings.push_back(15.0 * i);
  const auto grid = stable_on_grid(walls, stiffnesses, dampings);
  ASSERT_EQ(grid.size(), stiffnesses.size() * dampings.size());
  std::size_t stable = 0;
  for (std::size_t i = 0; i < dampings.size(); ++i) {
    const auto intervals = walls.stable_stiffnesses(dampings[i]);
    for (std::size_t j = 0; j < stiffnesses.size(); ++j) {
      const bool inside =
          !intervals.empty() && stiffnesses[j] > intervals[0].lower && stiffnesses[j] < *intervals[0].upper;
      EXPECT_EQ(grid[i * stiffnesses.size() + j] != 0, inside);
      stable += inside ? 1U : 0U;
    }
  }
  EXPECT_GT(stable, 100U);
}

TEST(StableWalls, RefuseWhatIsNoWall) {
  const FilteredPlant plant = filtered_plant(Device(test::lhifam_parameters()));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(StableWalls(plant, -1.0), Error);
  EXPECT_THROW(StableWalls(plant, nan), Error);
  const StableWalls walls(plant);
  EXPECT_THROW((void)walls.stable_stiffnesses(-1.0), Error);
  EXPECT_THROW((void)walls.stable_stiffnesses(nan), Error);
  EXPECT_THROW((void)stable_region(walls, {0.0}), Error);
  EXPECT_THROW((void)stable_region(walls, {nan}), Error);
  const std::vector<double> falling{2.0, 1.0};
  const std::vector<double> one{1.0};
  EXPECT_THROW((void)stable_on_grid(walls, falling, one), Error);
  EXPECT_THROW((void)stable_on_grid(walls, one, std::vector<double>{nan}), Error);
}

}  // namespace
}  // namespace zwidth
