// A device of a mechanism in the computations that take one, each against another: the planar arm, along x.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "zwidth/design/notch_design.hpp"
#include "zwidth/design/region.hpp"
#include "zwidth/error.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/simulation/simulate.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/grasp_limit.hpp"
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

TEST(MechanismAnswers, AWorstUserIsAskedOfBodiesAlone) {
  const std::optional<OptionProblem> problem = find_problem(AnalysisOptions{.worst_user = true}, arm(0.0));
  ASSERT_TRUE(problem && problem->problem);
  EXPECT_EQ(problem->problem->code, ProblemCode::coordinates_not_known);
}

// A damper leaves limits that are finite within 0.1 rad a sample alone: 13 467.576 N/m at B = 85.255..., where nobody has 2 % more. A
// spring of [[26415.558, -74453.452], [-74453.452, 209852.627]] N/m at the tip destabilises 13 600 N/m there.
TEST(MechanismAnswers, NoNarrowMinimumOverGraspsIsMissed) {
  const Device device = arm(0.0);
  const TipMotion motion = tip_motion_of(device).value();
  const double period = device.loop().sampling_period;
  DeviceParameters loop = device.parameters();
  const GraspedPlant plant(motion, loop, {1.0, 0.0, 0.0});
  std::vector<std::pair<double, GraspedPlant::Disc>> discs;
  for (int i = 20; i <= 2000; ++i) {
    const double frequency = std::numbers::pi / period * i / 2000.0;
    discs.emplace_back(frequency, plant.at(frequency));
  }
  for (double damping = 60.0; damping < 96.0; damping += 0.75) {
    SCOPED_TRACE(damping);
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [frequency, disc] : discs) {
      const std::complex<double> velocity = damping / period * (1.0 - std::polar(1.0, -frequency * period));
      // |1 + (K + g) c|^2 = |K + g|^2 r^2
      const double power = std::norm(disc.centre) - disc.radius * disc.radius;
      const double half = disc.centre.real() + power * velocity.real();
      const double constant = 1.0 + 2.0 * (velocity * disc.centre).real() + power * std::norm(velocity);
      const double root = half * half - power * constant;
      if (root < 0.0) continue;
      for (const double sign : {-1.0, 1.0}) {
        const double stiffness = (-half + sign * std::sqrt(root)) / power;
        if (stiffness > 0.0) least = std::min(least, stiffness);
      }
    }
    loop.wall.damping = damping;
    const double limit = any_grasp_limit(motion, loop, {1.0, 0.0, 0.0}).stiffness;
    EXPECT_LE(limit, least * (1.0 + 1e-9));
    EXPECT_GE(limit, least * (1.0 - 5e-3));  // what 2000 frequencies miss
  }
  loop.wall.damping = 85.25531189855045;
  EXPECT_NEAR(any_grasp_limit(motion, loop, {1.0, 0.0, 0.0}).stiffness / 13467.5761, 1.0, 1e-7);
}

// The tip hardly moves along the arm; who holds it there stops it all the same.
TEST(MechanismAnswers, NearASingularPoseTheLimitOverGraspsStays) {
  for (const double elbow : {1e-3, 1e-4, 1e-5, 3e-6, 1e-6, 1e-7, 1e-9, 1e-12, 0.0}) {
    SCOPED_TRACE(elbow);
    DeviceParameters parameters = arm(0.0).parameters();
    parameters.mechanism->mechanism.pose["elbow"] = elbow;
    parameters.mechanism->normal = {-std::sin(0.3), std::cos(0.3), 0.0};
    parameters.coordinates.reset();
    const Device device = device_of_mechanism(parameters);
    const GraspLimit limit =
        any_grasp_limit(tip_motion_of(device).value(), device.parameters(), {-std::sin(0.3), std::cos(0.3), 0.0});
    EXPECT_NEAR(limit.stiffness / 165.566, 1.0, 1e-4);
  }
}

// No hand keeps to the pose, of which the limit is higher: that beside it is the answer, and both are said.
TEST(MechanismAnswers, AtASingularPoseItIsThatBesideAndSaid) {
  DeviceParameters parameters = arm(0.0).parameters();
  parameters.mechanism->mechanism.pose["elbow"] = 0.0;
  parameters.mechanism->normal = {-std::sin(0.3), std::cos(0.3), 0.0};
  parameters.coordinates.reset();
  for (const bool is_point : {false, true}) {
    SCOPED_TRACE(is_point);
    parameters.mechanism->is_point = is_point;
    parameters.coordinates.reset();
    const Analysis found = analyze(device_of_mechanism(parameters));
    const double any_user = is_point ? found.point_wall->any_user->at_least : found.limits.any_user->critical_stiffness;
    EXPECT_NEAR(any_user / 165.566, 1.0, 1e-4);
    const auto said = std::ranges::find_if(found.remarks, [](const Remark& each) {
      return each.finding && each.finding->code == FindingCode::tip_loses_directions;
    });
    ASSERT_NE(said, found.remarks.end());
    const std::vector<Evidence>& evidence = said->finding->evidence;
    ASSERT_EQ(evidence.size(), 4U);
    EXPECT_EQ(evidence[0].value, 1.0);
    EXPECT_EQ(evidence[1].value, 2.0);
    EXPECT_NEAR(evidence[2].value / 176.164, 1.0, 1e-4);  // at rest, far below the pose's corner of 2.4 rad/s
    EXPECT_EQ(evidence[3].value, any_user);
  }
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

// A device along a normal knows its normal, whether or not a file of a mechanism stands behind it.
TEST(MechanismAnswers, any_user_grasps_the_tip_of_a_device_that_no_file_made) {
  const Device of_file = arm(100.0);
  DeviceParameters loop = of_file.parameters();
  loop.mechanism.reset();
  loop.coordinates.reset();
  const Device made = device_along(at_pose(of_file.parameters().mechanism->mechanism), {2.0, 0.0, 0.0}, loop);
  const double expected = analyze(of_file).limits.any_user->critical_stiffness;
  EXPECT_NEAR(analyze(made).limits.any_user->critical_stiffness / expected, 1.0, 1e-9);
  EXPECT_LT(expected, 0.99 * analyze(made).limits.nobody.critical_stiffness);
}

}  // namespace
}  // namespace zwidth
