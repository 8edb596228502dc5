#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

class ExportUnits : public Workspace {};

TEST_F(ExportUnits, TheDrivesOwnLoopMayBeGiven) {
  const std::string wall =
      "zwidth export devices/lhifam.toml --stiffness 3000 --set wall.damping=5 --set driver.travel=0.06 --units ";
  const Outcome slow = run(wall + "moteus --drive-rate 5000 --drive-delay 400e-6");
  EXPECT_EQ(slow.status, 0) << slow.errors;
  EXPECT_THAT(slow.output, HasSubstr("5000 Hz, as given, and a delay of 400 µs"));
  const Outcome odrive = run(wall + "odrive --estimator-bandwidth 2000");
  EXPECT_THAT(odrive.output, HasSubstr("encoder.config.bandwidth 2000 rad/s, as given"));
  EXPECT_THAT(odrive.output, HasSubstr("DOUBTFUL: the drive's current loop is not modelled"));
  EXPECT_THAT(run(wall + "odrive").output, HasSubstr("1000 rad/s, its default"));
  expect_refusal(wall + "odrive --estimator-bandwidth 4000", "--estimator-bandwidth: is 4000");
  EXPECT_THAT(run(wall + "moteus").output, HasSubstr("pll_filter_hz 400, its default"));
  const Outcome vesc = run(wall + "vesc --set actuator.force_limit=9");
  EXPECT_THAT(vesc.output, HasSubstr("the position is the encoder's"));
  EXPECT_THAT(vesc.output, HasSubstr("DOUBTFUL: the drive's current loop is not modelled"));
  expect_refusal(wall + "vesc --estimator-bandwidth 900 --set actuator.force_limit=9", "is for odrive");
  expect_refusal(wall + "moteus --drive-rate 0", "--drive-rate: is 0 Hz");
  expect_refusal(wall + "moteus --drive-delay -1", "--drive-delay: is -1");
  expect_refusal("zwidth export devices/lhifam.toml --format c --drive-rate 3", "--drive-rate: is for --units");
}

TEST_F(ExportUnits, OfADamperOfItsOwnTheDriveGetsTheDamperAlone) {
  const std::string damper =
      "zwidth export devices/lhifam.toml --set wall.damping=50 --set driver.travel=0.06 "
      "--set loop.damper.sampling_period=1e-4 --units ";
  const Outcome odrive = run(damper + "odrive --stiffness 4000");
  EXPECT_EQ(odrive.status, 0) << odrive.errors;
  EXPECT_THAT(odrive.output, AllOf(HasSubstr("10 kHz"), HasSubstr("1 kHz")));
  EXPECT_THAT(odrive.output, HasSubstr("139.4 kN/m"));
  EXPECT_THAT(odrive.output, HasSubstr("axis0.controller.config.vel_gain = 0.0286479"));  // 50 (0.06/2 pi)^2 2 pi
  EXPECT_THAT(odrive.output, Not(HasSubstr("pos_gain")));
  EXPECT_THAT(odrive.output, HasSubstr("DOUBTFUL"));
  const Outcome moteus = run(damper + "moteus");
  EXPECT_THAT(moteus.output, HasSubstr("servo.pid_position.kp = 0"));
  EXPECT_THAT(moteus.output, HasSubstr("servo.pid_position.kd = 0.0286479"));
  expect_refusal(damper + "vesc", "loop.damper");
  expect_refusal(damper + "odrive --drive-rate 8000", "--drive-rate: ");
}

// K 30 kN/m stands between the limit in any passive user's hand, 23.1, and that of the wall by itself, 41.2.
TEST_F(ExportUnits, AWallBeyondTheLimitWithAnyUserIsNotBelowIt) {
  const std::string wall =
      "zwidth export devices/lhifam.toml --set wall.damping=5 --set driver.travel=0.06 --units moteus --stiffness ";
  EXPECT_THAT(run(wall + "3000").output, HasSubstr("this wall is stable for anyone\n"));
  EXPECT_THAT(run(wall + "30000").output, HasSubstr("this wall is stable alone only\n"));
  EXPECT_THAT(run(wall + "50000").output, HasSubstr("this wall is UNSTABLE with nobody holding\n"));
}

}  // namespace
}  // namespace zwidth::cli
