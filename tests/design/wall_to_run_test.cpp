#include "zwidth/design/wall_to_run.hpp"

#include <gtest/gtest.h>

#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/device_trust.hpp"
#include "zwidth/stability/holder_limit.hpp"

namespace zwidth {
namespace {

Device lhifam(std::optional<double> stiffness) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.wall.stiffness = stiffness;
  return Device(parameters);
}

TEST(WallToRun, TakesTheStiffnessAskedForOrTheDevicesOwn) {
  const WallToRun own = wall_to_run(lhifam(3000.0));
  EXPECT_EQ(own.analysis.wall->stiffness, 3000.0);
  EXPECT_TRUE(own.released);
  EXPECT_FALSE(own.share);
  const WallToRun asked = wall_to_run(lhifam(3000.0), {.stiffness = 2000.0});
  EXPECT_EQ(asked.device.parameters().wall.stiffness, 2000.0);
  EXPECT_EQ(asked.analysis.wall->stiffness, 2000.0);
}

TEST(WallToRun, TakesTheShareThatSafeWallChooses) {
  const Device device = lhifam(std::nullopt);
  const WallToRun wall = wall_to_run(device, {.safety_factor = 0.4});
  ASSERT_TRUE(wall.share);
  EXPECT_EQ(wall.device.parameters().wall.stiffness, safe_wall(device, {.safety_factor = 0.4}).stiffness);
  EXPECT_TRUE(wall.analysis.wall->stable);
}

TEST(WallToRun, IsReleasedUnstableAndSaysSo) {
  const WallToRun wall = wall_to_run(lhifam(9500.0));
  EXPECT_TRUE(wall.released);
  EXPECT_FALSE(wall.analysis.wall->stable);
}

// 40 N m/rad was called stable, for the file's user holds: 14.2 are left once that one lets go.
TEST(WallToRun, IsJudgedWithNobodyAndWithTheFilesUser) {
  DeviceParameters knob;
  knob.motion = Motion::rotary;
  knob.bodies = {{"knob", 2e-3, 7.1e-3, 0.0, 0.0}};
  knob.loop = {0, 0, 0, 1e-3, 0.0};
  knob.user = {0.0, 6.5e-2, 0.0};
  const WallToRun wall = wall_to_run(Device(knob), {.stiffness = 40.0});
  ASSERT_TRUE(wall.analysis.wall_stable_for);
  EXPECT_TRUE(wall.analysis.wall->stable);
  EXPECT_EQ(stability_of(*wall.analysis.wall_stable_for), WallStability::unstable);
  EXPECT_EQ(unstable_with(*wall.analysis.wall_stable_for), "with nobody holding");
  EXPECT_EQ(unstable_with({true, true, false}), "");
  EXPECT_EQ(unstable_with({true, false, false}), "with the file's user");
  EXPECT_EQ(unstable_with({false, false, false}), "with nobody holding and with the file's user");
  const WallToRun share = wall_to_run(Device(knob), {.safety_factor = 0.9});
  ASSERT_TRUE(share.share);
  EXPECT_LT(share.share->stiffness, 14.2);
  EXPECT_EQ(stability_of(*share.analysis.wall_stable_for), WallStability::anyone);
}

TEST(WallToRun, OfADoubtfulDeviceIsReleasedOnlyWhereThatIsAccepted) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.wall.stiffness = 3000.0;
  parameters.uncertainty.emplace();
  parameters.uncertainty->warning = "the crossover was not measured";
  const Device device(parameters);
  ASSERT_EQ(trust_of(device).verdict, Trust::Verdict::doubtful);
  EXPECT_FALSE(wall_to_run(device).released);
  EXPECT_TRUE(wall_to_run(device, {.accept_doubt = true}).released);
}

TEST(WallToRun, IsNotThereWhereNoWallIsStable) {
  DeviceParameters parameters = test::rigid_parameters();
  parameters.bodies[0].damping = 0.0;
  const WallToRun wall = wall_to_run(Device(parameters), {.safety_factor = 0.5});
  ASSERT_TRUE(wall.share);
  EXPECT_NE(wall.share->status, SafeWall::Status::chosen);
  EXPECT_FALSE(wall.released);
  EXPECT_FALSE(wall.device.parameters().wall.stiffness);
}

TEST(WallToRun, FindsWhatCannotBeAsked) {
  EXPECT_EQ(find_problem(WallToRunOptions{}, lhifam(std::nullopt))->member, "wall.stiffness");
  EXPECT_FALSE(find_problem(WallToRunOptions{}, lhifam(3000.0)));
  EXPECT_EQ(find_problem(WallToRunOptions{.stiffness = -3.0}, lhifam(std::nullopt))->member, "stiffness");
  EXPECT_EQ(find_problem(WallToRunOptions{.safety_factor = 1.0}, lhifam(std::nullopt))->member, "safety_factor");
  EXPECT_EQ(find_problem(WallToRunOptions{.stiffness = 3.0, .safety_factor = 0.5}, lhifam(std::nullopt))->member,
            "safety_factor");
  EXPECT_THROW((void)wall_to_run(lhifam(std::nullopt)), Error);
}

}  // namespace
}  // namespace zwidth
