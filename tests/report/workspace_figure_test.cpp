// The picture of a workspace, of answers made here: no mechanism is needed for it.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "lhifam.hpp"
#include "report/figure/figures.hpp"
#include "zwidth/workspace.hpp"

namespace zwidth::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr double unbounded = std::numeric_limits<double>::infinity();

DirectionLimits limits_at(const Eigen::Vector3d& normal, double nobody) {
  DirectionLimits limits;
  limits.normal = normal;
  limits.status = std::isfinite(nobody) ? StiffnessStatus::finite : StiffnessStatus::unbounded;
  limits.nobody = nobody;
  limits.any_user = 0.9 * nobody;
  return limits;
}

/// At the tip, with limits from `softest` along x to three times that across it.
WorkspacePose pose_at(const Eigen::Vector3d& tip, double softest, bool is_spatial) {
  WorkspacePose pose;
  pose.pose = {{"elbow", 0.5 * std::numbers::pi}, {"slide", 0.02}};
  pose.joints = {0.5 * std::numbers::pi, 0.02};
  pose.tip = tip;
  for (int i = 0; i < 8; ++i) {
    const double angle = i * std::numbers::pi / 8.0;
    const double up = is_spatial ? 0.1 * i : 0.0;
    const double flat = std::sqrt(1.0 - up * up);
    pose.directions.push_back(limits_at({flat * std::cos(angle), flat * std::sin(angle), up},
                                        softest * (1.0 + 2.0 * std::abs(std::sin(angle)))));
  }
  pose.least = pose.least_any_user = pose.directions.front();
  pose.greatest = pose.directions[4];
  return pose;
}

Workspace found(std::size_t tip_directions, bool is_spatial = false) {
  Workspace workspace;
  workspace.joints = {{.name = "elbow", .motion = Motion::rotary}, {.name = "slide", .motion = Motion::linear}};
  workspace.pose_joints = {"elbow", "slide"};
  workspace.tip_directions = tip_directions;
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 6; ++j) {
      workspace.poses.push_back(
          pose_at({0.05 * i, 0.04 * j, is_spatial ? 0.01 * i * j : 0.0}, 200.0 + 10.0 * (i + j), is_spatial));
    }
  }
  WorkspaceLimit least;
  least.stiffness = 200.0;
  least.normal = Eigen::Vector3d::UnitX();
  workspace.least = least;
  least.stiffness = 180.0;
  workspace.least_any_user = least;
  return workspace;
}

std::string drawn(const Workspace& workspace, FigureFormat format = FigureFormat::svg) {
  static const Device device(test::lhifam_parameters());
  return draw_workspace(device, workspace, format);
}

std::size_t count(const std::string& text, const std::string& what) {
  std::size_t number = 0;
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++number;
  return number;
}

constexpr const char* dot = "xlink:href='#gpPt6'";

TEST(WorkspaceFigure, APlaneIsOneMapWithTheWorstPose) {
  const std::string picture = drawn(found(2));
  for (const char* text :
       {"x of the tip (mm)", "y of the tip (mm)", "K (N/m)", "180 N/m", "200 N/m", "elbow 90°", "slide 20 mm"}) {
    EXPECT_THAT(picture, HasSubstr(text));
  }
  EXPECT_EQ(count(picture, dot), 36U);
  EXPECT_THAT(picture, Not(HasSubstr("z of the tip")));
}

TEST(WorkspaceFigure, SpaceIsSeenAlongThreeAxesWithTheDirectionsOfTheWorstPose) {
  const std::string picture = drawn(found(3, true));
  for (const char* text : {"x of the tip (mm)", "y of the tip (mm)", "z of the tip (mm)", "x of the normal"}) {
    EXPECT_THAT(picture, HasSubstr(text));
  }
  EXPECT_GT(count(picture, dot), 3U * 30U);
}

TEST(WorkspaceFigure, WithoutAnyUserItIsThatOfNobody) {
  Workspace workspace = found(2);
  workspace.least_any_user.reset();
  const std::string picture = drawn(workspace);
  EXPECT_THAT(picture, HasSubstr("200 N/m"));
  EXPECT_THAT(picture, Not(HasSubstr("180 N/m")));
}

TEST(WorkspaceFigure, PosesWithoutALimitAreNoDots) {
  Workspace workspace = found(2);
  WorkspacePose& singular = workspace.poses[7];
  singular.directions.clear();
  singular.least = singular.greatest = singular.least_any_user = std::nullopt;
  singular.problem = Problem{};
  workspace.poses[8].joints.clear();  // not reached: the tip is nowhere
  workspace.poses[9].least_any_user = limits_at(Eigen::Vector3d::UnitX(), 0.0);
  EXPECT_EQ(count(drawn(workspace), dot), 33U);
}

TEST(WorkspaceFigure, WhatIsUnboundedHasAColour) {
  Workspace workspace = found(2);
  for (WorkspacePose& each : workspace.poses) {
    each.least = each.least_any_user = limits_at(Eigen::Vector3d::UnitX(), unbounded);
  }
  workspace.least->stiffness = workspace.least_any_user->stiffness = unbounded;
  EXPECT_EQ(count(drawn(workspace), dot), 36U);
}

TEST(WorkspaceFigure, OnePoseALineOfPosesAndNoneAreDrawn) {
  Workspace line = found(1);
  for (WorkspacePose& each : line.poses) each.tip.y() = 0.0;
  EXPECT_EQ(count(drawn(line), dot), 6U);
  Workspace one = found(2);
  one.poses.resize(1);
  EXPECT_EQ(count(drawn(one), dot), 1U);
  Workspace none;
  none.trust.verdict = Trust::Verdict::refused;
  EXPECT_THAT(drawn(none), HasSubstr("<svg"));
}

TEST(WorkspaceFigure, IsDrawnInEveryFormat) {
  EXPECT_THAT(drawn(found(2), FigureFormat::png), ::testing::StartsWith("\x89PNG"));
  EXPECT_THAT(drawn(found(3, true), FigureFormat::pdf), ::testing::StartsWith("%PDF"));
}

}  // namespace
}  // namespace zwidth::report
