#include "zwidth/study/region_contours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "campaign.hpp"
#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "study/random_studies.hpp"
#include "zwidth/design/region.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/study/study_run.hpp"

namespace zwidth {
namespace {

using Kind = Distribution::Kind;

StudyRun lhifam_run(std::uint64_t samples) {
  return {Device(test::lhifam_parameters()),
          {{{"body.motor.mass", {.kind = Kind::uniform, .lower = 0.27, .upper = 0.33}},
            {"link.stiffness", {.kind = Kind::normal, .centre = 79.5e3, .deviation = 6e3}},
            {"body.handle.damping", {.kind = Kind::triangular, .centre = 3.4, .lower = 1.0, .upper = 4.0}}}},
          {.samples = samples}};
}

/// The stiffest wall of this damping that is stable with every softer one; 0 where there is none.
double limit_of(const StableWalls& walls, double damping) {
  const auto intervals = walls.stable_stiffnesses(damping);
  return intervals.empty() || intervals.front().lower > 0.0 ? 0.0 : *intervals.front().upper;
}

// Units that hardly differ have one region: that of the device, found by another route.
TEST(RegionContours, AreTheRegionWhereUnitsHardlyDiffer) {
  const unsigned seeds = test::by_tier(2U, 4U);
  std::size_t compared = 0;
  for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
    SCOPED_TRACE(seed);
    test::RandomDevices random(seed);
    const Device device(random.device(seed % 2 == 0 ? "two_mass" : "fractional_delay"));
    const double mass = *parameter(device.parameters(), "body.motor.mass");
    const StudyRun run(device,
                       {{{"body.motor.mass", {.kind = Kind::uniform, .lower = mass, .upper = mass * (1.0 + 1e-12)}}}},
                       {.samples = least_region_units});
    const RegionContours found = region_contours(run, least_region_units);
    const WallRegion region = zwidth::region(device, {.any_user = false, .approximations = false});
    ASSERT_FALSE(found.contours.empty());
    for (std::size_t i = 0; i < found.dampings.size(); ++i) {
      const double expected = limit_of(*region.walls, found.dampings[i]);
      for (const RegionContour& each : found.contours) {
        EXPECT_NEAR(each.stiffness[i], expected, 1e-6 * region.region.stiffest->stiffness) << found.dampings[i];
      }
      compared += expected > 0.0 ? 1U : 0U;
    }
    // The grid ends behind the region, and not far.
    EXPECT_GE(found.dampings.back(), region.region.most_damped->damping * (1.0 - 1e-9));
  }
  EXPECT_GT(compared, 25 * seeds);
}

// What the contours say of a wall is what counting the units that render it says.
TEST(RegionContours, AreTheSharesOfUnitsCountedOneByOne) {
  constexpr std::uint64_t units = 400;
  const StudyRun run = lhifam_run(units);
  const RegionContours found = region_contours(run, units);
  EXPECT_TRUE(found.trust.sound());
  EXPECT_EQ(found.dampings.size(), region_grid_points);
  EXPECT_EQ(found.dampings.front(), 0.0);
  std::vector<double> row(run.inputs().size());
  for (const std::size_t i : {std::size_t{0}, std::size_t{7}, std::size_t{31}}) {
    std::vector<double> limits;
    for (std::uint64_t unit = 0; unit < units; ++unit) {
      run.values(unit, row);
      DeviceParameters parameters = run.device().parameters();
      for (std::size_t j = 0; j < row.size(); ++j) {
        set_parameter(parameters, run.distributions().parameters[j].key, row[j]);
      }
      limits.push_back(limit_of(StableWalls(filtered_plant(Device(parameters))), found.dampings[i]));
    }
    for (const RegionContour& each : found.contours) {
      const double wall = each.stiffness[i];
      const auto reach = [&](double stiffness) {
        return static_cast<double>(std::ranges::count_if(limits, [&](double limit) { return limit >= stiffness; }));
      };
      ASSERT_GT(wall, 0.0);
      EXPECT_GE(reach(wall * (1.0 - 1e-7)), each.share * units) << found.dampings[i];
      EXPECT_LE(reach(wall * (1.0 + 1e-7)), each.share * units) << found.dampings[i];
      EXPECT_LE(each.lower[i], wall);
      EXPECT_GE(each.upper[i], wall);
    }
  }
}

TEST(RegionContours, LieWithinEachOtherAndEnd) {
  for (std::uint64_t seed = 1; seed <= test::by_tier(1U, 3U); ++seed) {
    const StudyRun run = test::random_study(seed, {.samples = 400});
    const RegionContours found = region_contours(run, 400);
    SCOPED_TRACE(seed);
    ASSERT_EQ(found.contours.size(), 3U);
    for (std::size_t i = 0; i < found.dampings.size(); ++i) {
      EXPECT_LE(found.contours[0].stiffness[i], found.contours[1].stiffness[i]);
      EXPECT_LE(found.contours[1].stiffness[i], found.contours[2].stiffness[i]);
    }
    EXPECT_EQ(found.contours[2].stiffness.back(), 0.0);
  }
}

// At the damping of the device they are the quantiles of the study.
TEST(RegionContours, AgreeWithTheQuantilesOfTheStudy) {
  const StudyRun run = lhifam_run(400);
  const StudyOptions options{
      .samples = 400, .index_samples = 0, .tightening_samples = 0, .region_units = 400, .worst = false};
  const Study found = study(run.device(), run.distributions(), options);
  ASSERT_TRUE(found.regions);
  for (const QuantileEstimate& each : found.quantiles) {
    for (const RegionContour& contour : found.regions->contours) {
      if (std::abs(1.0 - contour.share - each.probability) > 1e-9) continue;
      EXPECT_EQ(contour.stiffness.front(), *each.value);
      EXPECT_EQ(contour.lower.front(), *each.lower);
      EXPECT_EQ(contour.upper.front(), *each.upper);
    }
  }
}

TEST(RegionContours, AreTheSameForAnyNumberOfThreads) {
  const StudyRun one = lhifam_run(400);
  const RegionContours expected = region_contours(one, 400);
  for (const std::size_t threads : {1U, 7U}) {
    const StudyRun run(one.device(), one.distributions(), {.samples = 400, .threads = threads});
    const RegionContours found = region_contours(run, 400);
    EXPECT_EQ(found.dampings, expected.dampings);
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found.contours[i].stiffness, expected.contours[i].stiffness);
  }
}

TEST(RegionContours, EndWhereTheProgressThrows) {
  double last = 0.0;
  const auto stop = [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
    if (fraction > 0.5) throw std::runtime_error("enough");
  };
  EXPECT_THROW((void)region_contours(lhifam_run(400), 400, stop), std::runtime_error);
  EXPECT_LT(last, 0.7);
}

TEST(RegionContours, RefuseWhatCannotBeTold) {
  const StudyRun run = lhifam_run(1000);
  for (const std::uint64_t units : {std::uint64_t{0}, least_region_units - 1, std::uint64_t{1001}}) {
    EXPECT_THROW((void)region_contours(run, units), Error) << units;
  }
  const StudyDistributions damped{{{"wall.damping", {.kind = Kind::uniform, .lower = 0.0, .upper = 1.0}}}};
  const auto problem = find_problem(StudyOptions{.region_units = 400}, run.device(), damped);
  ASSERT_TRUE(problem);
  EXPECT_EQ(problem->member, "region_units");
  // Without damping that tells the scale: nothing moves what the wall senses.
  const Device still(test::transfer_function_parameters({1.0}, {1.0, -8.0, 0.0}, 1.0));
  const StudyRun hopeless(still, {{{"loop.delay", {.kind = Kind::uniform, .lower = 0.0, .upper = 0.1}}}},
                          {.samples = 1000});
  const RegionContours none = region_contours(hopeless, 400);
  EXPECT_TRUE(none.trust.refused());
  EXPECT_TRUE(none.contours.empty());
}

// Units without an answer render nothing; they are counted, not dropped.
TEST(RegionContours, AreDoubtfulWhereUnitsHaveNoAnswer) {
  const StudyRun run(Device(test::lhifam_parameters()),
                     {{{"link.stiffness", {.kind = Kind::discrete, .values = {0.0, 79.5e3}, .weights = {1.0, 5.0}}},
                       {"link.damping", {.kind = Kind::discrete, .values = {0.0, 15.0}, .weights = {1.0, 5.0}}}}},
                     {.samples = 400});
  const RegionContours found = region_contours(run, 400);
  EXPECT_EQ(found.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_EQ(found.contours.front().stiffness.front(), 0.0);  // of 1 in 36
  EXPECT_GT(found.contours[1].stiffness.front(), 0.0);
}

}  // namespace
}  // namespace zwidth
