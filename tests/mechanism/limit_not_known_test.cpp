// Three joints, two directions, and a corner too slow for the sampling rate: the limit for any user is not known. No wall is proposed,
// none is called harmless, and nobody's limit does not stand for it.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "zwidth/design/design_target.hpp"
#include "zwidth/design/region.hpp"
#include "zwidth/design/safe_wall.hpp"
#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/workspace.hpp"

namespace zwidth {
namespace {

Device slow_arm(double period) {
  std::string bodies;
  for (const auto& [joint, damping] : {std::pair{"a", 2e-3}, {"b", 2e-4}, {"c", 1e-3}}) {
    bodies += "<body pos='" + std::string(bodies.empty() ? "0" : "0.2") + " 0 0'><joint name='" + joint +
              "' axis='0 0 1' damping='" + std::to_string(damping) +
              "'/><inertial pos='0.1 0 0' mass='0.3' diaginertia='1e-4 2e-3 2e-3'/>";
  }
  MechanismFile file;
  file.tip = "tip";
  file.text = "<mujoco><compiler angle='radian'/><worldbody>" + bodies +
              "<site name='tip' pos='0.15 0 0'/></body></body></body></worldbody><actuator><motor joint='a'/><motor "
              "joint='b'/><motor joint='c'/></actuator></mujoco>";
  file.pose = {{"a", 0.3}, {"b", 0.8}, {"c", 0.7}};
  DeviceParameters parameters;
  parameters.mechanism = MechanismDirection{file, {1.0, 0.0, 0.0}};
  parameters.loop.sampling_period = period;
  return device_of_mechanism(std::move(parameters));
}

bool has_finding(const std::vector<Remark>& remarks, FindingCode code) {
  return std::ranges::any_of(remarks,
                             [code](const Remark& each) { return each.finding && each.finding->code == code; });
}

TEST(LimitNotKnown, NoWallRestsOnIt) {
  EXPECT_EQ(recommend_wall(slow_arm(1e-3), {.alternatives = false}).status, WallRecommendation::Status::found);
  const Device fast = slow_arm(1e-7);
  EXPECT_FALSE(analyze(fast).any_user);
  const WallRecommendation none = recommend_wall(fast, {.alternatives = false});
  EXPECT_EQ(none.status, WallRecommendation::Status::none);
  ASSERT_TRUE(none.reason);
  EXPECT_EQ(none.reason->code, FindingCode::any_grasp_not_known);
  const WallRegion walls = region(fast);
  EXPECT_FALSE(walls.any_user);
  EXPECT_TRUE(has_finding(walls.remarks, FindingCode::any_grasp_not_known));
  const SafeWall safe = safe_wall(fast);
  EXPECT_EQ(safe.status, SafeWall::Status::refused);
  EXPECT_EQ(safe.trust.findings.front().code, FindingCode::any_grasp_not_known);
  const DesignTargets targets =
      design_targets(fast, {.goal = StiffnessGoal::absolute_stability_limit, .times_now = 2.0});
  EXPECT_TRUE(targets.trust.refused());
  EXPECT_TRUE(targets.targets.empty());
}

// Dampings of six decades: rounding of the fast corners is greater than the slowest one, which sets the limit at 2e-8 rad a sample
// (5.874 N/m at the longer period, where the scan's own end says 57).
TEST(LimitNotKnown, WhereRoundingHidesTheSlowestCorner) {
  for (const double period : {1.387e-4, 5e-5}) {
    SCOPED_TRACE(period);
    MechanismFile file;
    file.path = ZWIDTH_SOURCE_DIR "/tests/mechanism/slow_corner_arm.xml";
    file.tip = "tip";
    file.pose = {{"j0", 0.238767}, {"j1", -0.901774}, {"j2", -0.927779}, {"j3", 0.075798}, {"j4", -0.949302}};
    DeviceParameters parameters;
    parameters.mechanism = MechanismDirection{file, {-0.181062, -0.936842, -0.299238}};
    parameters.loop.sampling_period = period;
    const Analysis analysis = analyze(device_of_mechanism(std::move(parameters)));
    EXPECT_GT(analysis.critical.stiffness, 6000.0);
    EXPECT_FALSE(analysis.any_user);
    EXPECT_TRUE(has_finding(analysis.remarks, FindingCode::any_grasp_not_known));
  }
}

// There it may be the least.
TEST(LimitNotKnown, AtOnePoseItLeavesTheWorkspaceDoubtful) {
  const Device device = slow_arm(2.6e-5);
  const WorkspaceOptions options{.poses = {{{"b", 0.8}}, {{"b", 2.9}}}, .normals = {{1.0, 0.0, 0.0}}, .stiffness = 1.0};
  const Workspace found = workspace(device, options);
  ASSERT_TRUE(found.poses[0].least_any_user && found.poses[1].least);
  EXPECT_FALSE(found.poses[1].least_any_user);
  EXPECT_FALSE(found.trust.sound());
  EXPECT_EQ(found.trust.findings.front().code, FindingCode::any_grasp_not_known_somewhere);
  ASSERT_TRUE(found.least_any_user && found.share_at_least);
  EXPECT_EQ(found.least_any_user->pose, 0U);
  EXPECT_EQ(found.quantiles.front().any_user, 0.0);
  EXPECT_EQ(found.share_at_least->any_user, 0.5);
  EXPECT_EQ(found.share_at_least->nobody, 1.0);
  WorkspaceOptions unknown = options;
  unknown.poses.erase(unknown.poses.begin());
  const Workspace alone = workspace(device, unknown);
  EXPECT_TRUE(alone.trust.sound());
  EXPECT_TRUE(has_finding(alone.remarks, FindingCode::any_grasp_not_known));
  EXPECT_FALSE(alone.least_any_user || alone.quantiles.front().any_user || alone.share_at_least->any_user);
}

}  // namespace
}  // namespace zwidth
