// Walls that run, regions and simulations are judged with nobody and with the file's user: a person lets go of the handle.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A knob that its user damps: 14.2 N m/rad with nobody holding, ten times as much in that hand.
class WhoHolds : public Workspace {
 protected:
  WhoHolds() {
    write("knob.toml",
          "name = 'knob'\nmotion = 'rotary'\n[[body]]\nname = 'knob'\ninertia = 2e-3\ndamping = 7.1e-3\n"
          "[loop]\nsampling_period = 1e-3\n[operator]\ndamping = 6.5e-2\n[driver]\n");
  }
  nlohmann::json json(const std::string& arguments) const {
    const Outcome outcome = run("zwidth " + arguments + " --json");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output, nullptr, false);
  }
};

TEST_F(WhoHolds, TheRigRendersNoWallThatShakesOnceTheUserLetsGo) {
  const Outcome refused = run("zwidth rig wall knob.toml --stiffness 40 --duration 0.5");
  EXPECT_EQ(refused.status, 1);
  EXPECT_EQ(refused.output, "");
  EXPECT_THAT(refused.errors, HasSubstr("UNSTABLE by linear analysis, with nobody holding; --accept-unstable"));
  const auto wall = json("rig wall knob.toml --stiffness 40 --duration 0.5 --accept-unstable");
  EXPECT_EQ(wall["stable_for"], nlohmann::json({{"nobody", false}, {"user", true}, {"any_user", false}}));
  EXPECT_EQ(wall["predicted_stable"], false);
  EXPECT_EQ(wall["trust"]["verdict"], "doubtful");
  EXPECT_NEAR(wall["limits"]["nobody"]["critical_stiffness"].get<double>(), 14.2, 0.05);
  EXPECT_EQ(wall["limits"]["user"]["critical_stiffness"], wall["predicted"]["critical_stiffness"]);
  EXPECT_EQ(json("rig wall knob.toml --stiffness 10 --duration 0.5")["predicted_stable"], true);
}

TEST_F(WhoHolds, EveryDocumentOfALimitHasThoseOfEveryHolder) {
  const auto limits = json("analyze knob.toml")["limits"];
  ASSERT_TRUE(limits["nobody"]["critical_stiffness"].is_number());
  ASSERT_TRUE(limits["user"]["critical_stiffness"].is_number());
  ASSERT_TRUE(limits["any_user"]["critical_damping"].is_number());
  for (const char* command : {"region knob.toml", "design knob.toml", "design knob.toml --target 20",
                              "design knob.toml --recommend", "diagnose knob.toml --oscillates-hz 20 --stiffness 40"}) {
    EXPECT_EQ(json(command)["limits"], limits) << command;
  }
}

TEST_F(WhoHolds, AnExportedHeaderSaysIt) {
  const Outcome unstable = run("zwidth export knob.toml --format c --stiffness 40");
  EXPECT_EQ(unstable.status, 0);
  EXPECT_THAT(unstable.errors, HasSubstr("UNSTABLE by linear analysis, with nobody holding"));
  EXPECT_THAT(unstable.output, HasSubstr("nobody holding    14.21 N m/rad\n"));
  EXPECT_THAT(unstable.output, HasSubstr("the file's user   145.1 N m/rad"));
  EXPECT_THAT(unstable.output, HasSubstr("any passive user  14.2 N m/rad\n"));
  EXPECT_THAT(unstable.output, HasSubstr("this wall is        unstable\n"));
  EXPECT_THAT(unstable.output,
              HasSubstr("WARNING: with this wall the loop is UNSTABLE by linear analysis, with nobody"));
  const Outcome stable = run("zwidth export knob.toml --format c --stiffness 10");
  EXPECT_EQ(stable.errors, "");
  EXPECT_THAT(stable.output, HasSubstr("this wall is        stable for anyone\n"));
  EXPECT_THAT(stable.output, Not(HasSubstr("UNSTABLE")));
}

TEST_F(WhoHolds, SoDoTheNumbersOfADrive) {
  const Outcome wall = run("zwidth export knob.toml --units moteus --stiffness 150");
  EXPECT_EQ(wall.status, 0);
  EXPECT_THAT(wall.errors,
              HasSubstr("closed on the drive, the wall is UNSTABLE by linear analysis, with nobody holding"));
  EXPECT_THAT(wall.output, HasSubstr("this wall is UNSTABLE with nobody holding\n"));
  EXPECT_THAT(run("zwidth export knob.toml --units moteus --stiffness 1").output,
              HasSubstr("this wall is stable for anyone\n"));
}

TEST_F(WhoHolds, TheRegionHasBoth) {
  const auto region = json("region knob.toml");
  EXPECT_NEAR(region["nobody"]["critical_stiffness"].get<double>(), 14.2, 0.05);
  EXPECT_GT(region["critical_stiffness"].get<double>(), 135.0);
  EXPECT_EQ(region["nobody_and_user"]["critical_stiffness"], region["nobody"]["critical_stiffness"]);
  EXPECT_EQ(region["nobody_and_user"]["stiffest"]["holder"], "nobody");
  EXPECT_EQ(region["nobody_and_user"]["stiffest"]["stiffness"], region["nobody"]["stiffest"]["stiffness"]);
  EXPECT_EQ(region["nobody"]["status"], "bounded");
  EXPECT_FALSE(region["nobody"]["components"].empty());
  const Outcome text = run("zwidth region knob.toml -o region.svg --csv region.csv");
  EXPECT_THAT(text.output, HasSubstr("14.2"));
  EXPECT_THAT(text.output, HasSubstr("nobody holding and the file's user"));
  EXPECT_THAT(contents("region.svg"), HasSubstr("nobody holding and with the file"));
  EXPECT_THAT(contents("region.csv"), HasSubstr(",sound,user\n"));
  EXPECT_THAT(contents("region.csv"), HasSubstr(",sound,nobody\n"));
  const auto alone = json("region devices/lhifam_rigid.toml");
  EXPECT_TRUE(alone["nobody"].is_null());
  EXPECT_TRUE(alone["nobody_and_user"].is_null());
}

TEST_F(WhoHolds, ARasterIsOfWallsForBoth) {
  ASSERT_EQ(run("zwidth region knob.toml --raster 40 --csv map.csv").status, 0);
  ASSERT_EQ(run("zwidth region knob.toml --set operator.damping=0 --raster 2 --csv alone.csv").status, 0);
  std::istringstream lines(contents("map.csv"));
  std::string line;
  std::getline(lines, line);
  int stable = 0;
  while (std::getline(lines, line)) {
    if (!line.ends_with(",1,sound")) continue;
    ++stable;
    // Of a rigid device that nobody holds: K T/2 + B is less than 2 m/T at the most.
    EXPECT_LT(std::stod(line), 2.0 * 2e-3 / 1e-6);
  }
  EXPECT_GT(stable, 0);
}

TEST_F(WhoHolds, ASimulationSaysWhoseLimitItIs) {
  const auto held = json("simulate knob.toml --set wall.stiffness=40 --duration 1");
  EXPECT_EQ(held["linear"]["wall_stable"], true);  // as it moved, in the hand of the user
  EXPECT_EQ(held["linear"]["stable_for"]["nobody"], false);
  EXPECT_EQ(held["linear"]["stable_for"]["user"], true);
  EXPECT_EQ(held["linear"]["limits"]["user"]["critical_stiffness"], held["linear"]["critical_stiffness"]);
  EXPECT_THAT(run("zwidth simulate knob.toml --set wall.stiffness=40 --duration 1").output,
              HasSubstr("UNSTABLE with nobody"));
}

TEST_F(WhoHolds, AStudySaysWhoseLimitsItIs) {
  write("study.toml", "[[parameter]]\nkey = 'body.knob.damping'\ndistribution = 'uniform'\nrelative_tolerance = 0.1\n");
  const auto study = json("study knob.toml --study study.toml --samples 200");
  EXPECT_NEAR(study["limits"]["nobody"]["critical_stiffness"].get<double>(), 14.2, 0.05);
  EXPECT_GT(study["limits"]["user"]["critical_stiffness"].get<double>(), 135.0);
  EXPECT_EQ(study["remarks"][0]["severity"], "warning");
  const auto alone = json("study knob.toml --study study.toml --samples 200 --set operator.damping=0");
  EXPECT_TRUE(alone["limits"]["user"].is_null());
}

TEST_F(WhoHolds, TheLimitOnTheRigHasAllThree) {
  const auto limit = json("rig limit knob.toml");
  EXPECT_NEAR(limit["limits"]["nobody"]["critical_stiffness"].get<double>(), 14.2, 0.05);
  EXPECT_EQ(limit["limits"]["user"]["critical_stiffness"], limit["predicted"]["critical_stiffness"]);
  EXPECT_EQ(limit["limits"]["any_user"]["critical_stiffness"], limit["any_user"]["critical_stiffness"]);
  EXPECT_EQ(limit["remarks"], nlohmann::json::array());
  EXPECT_EQ(limit["trust"]["verdict"], "sound");
}

}  // namespace
}  // namespace zwidth::cli
