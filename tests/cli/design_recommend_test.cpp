#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;

class DesignRecommend : public Workspace {
 protected:
  [[nodiscard]] nlohmann::json answer(const std::string& command) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output);
  }
};

TEST_F(DesignRecommend, WritesADeviceThatAnalyzeConfirms) {
  const auto recommended = answer(
      "zwidth design devices/lhifam.toml --recommend --ripple 0.1 --gain-margin-db 8 --phase-margin-deg 40 --json "
      "--write walled.toml");
  ASSERT_EQ(recommended["schema"], "zwidth.wall_recommendation/1");
  ASSERT_EQ(recommended["status"], "found");
  const auto analysis = answer("zwidth analyze walled.toml --json");
  const auto& wall = analysis["wall"];
  EXPECT_EQ(wall["stiffness"], recommended["wall"]["stiffness"]);
  EXPECT_TRUE(wall["stable"].get<bool>());
  EXPECT_GE(wall["gain_margin_db"].get<double>(), 8.0 - 1e-6);
  EXPECT_GE(wall["stiffness_margin_db"].get<double>(), 8.0 - 1e-6);
  EXPECT_GE(wall["phase_margin_rad"].get<double>(), 40.0 * 3.14159265 / 180.0 - 1e-6);
  EXPECT_EQ(analysis["any_user"]["critical_stiffness"], recommended["margins"]["any_user_critical_stiffness"]);
  EXPECT_GE(analysis["any_user"]["critical_stiffness"].get<double>(), 2.5118864315 * wall["stiffness"].get<double>());
  EXPECT_LE(recommended["force_per_count"]["largest"].get<double>(), 0.1);
  EXPECT_GE(recommended["alternatives"].size(), 3U);
}

// Behind its velocity filter the wall is stable; without it this one would lie outside of the region.
TEST_F(DesignRecommend, DrawsTheWallInTheRegionBehindItsFilter) {
  const Outcome drawn = run("zwidth design devices/capstan_paddle.toml --recommend --figure wall.svg");
  ASSERT_EQ(drawn.status, 0) << drawn.errors;
  EXPECT_THAT(contents("wall.svg"), HasSubstr("recommended: 315.3 mN m/rad"));
}

TEST_F(DesignRecommend, SaysWhatBoundsItInText) {
  const Outcome outcome = run("zwidth design devices/lhifam.toml --recommend");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("bounded by"));
  EXPECT_THAT(outcome.output, HasSubstr("force per count"));
  EXPECT_THAT(outcome.output, HasSubstr("[wall]"));
  EXPECT_THAT(outcome.output, HasSubstr("no greatest force per encoder count was asked"));
}

TEST_F(DesignRecommend, WithoutAnEncoderTheForcePerCountIsSaidToBeUnbounded) {
  const auto answer_of = answer("zwidth design devices/two_mass_drive.toml --recommend --ripple 0.1 --json");
  EXPECT_TRUE(answer_of["force_per_count"].is_null());
  EXPECT_THAT(answer_of["remarks"].dump(), HasSubstr("could not be bounded"));
}

// Nothing damps the device but the wall: a user of the right mass destabilises any wall.
TEST_F(DesignRecommend, SaysWhyThereIsNone) {
  write("undamped.toml", "[[body]]\nname = \"a\"\nmass = 1.0\n[loop]\nsampling_period = 1e-3\n");
  const auto none = answer("zwidth design undamped.toml --recommend --json");
  EXPECT_EQ(none["status"], "none");
  EXPECT_TRUE(none["wall"].is_null());
  EXPECT_THAT(none["reason"].get<std::string>(), HasSubstr("passive user"));
}

TEST_F(DesignRecommend, ADoubtfulDeviceGivesADoubtfulWall) {
  write("doubtful.toml",
        "[[body]]\nname = \"a\"\nmass = 1.0\ndamping = 5.0\n[loop]\nsampling_period = 1e-3\n[uncertainty]\n"
        "verdict = \"doubtful\"\nreasons = [\"measured on another rig\"]\n");
  const auto doubtful = answer("zwidth design doubtful.toml --recommend --json");
  EXPECT_EQ(doubtful["status"], "found");
  EXPECT_EQ(doubtful["trust"]["verdict"], "doubtful");
  EXPECT_THAT(doubtful["trust"]["reasons"].dump(), HasSubstr("measured on another rig"));
  write("refused.toml",
        "[[body]]\nname = \"a\"\nmass = 1.0\ndamping = 5.0\n[loop]\nsampling_period = 1e-3\n[uncertainty]\n"
        "verdict = \"refused\"\nreasons = [\"nothing was determined\"]\n");
  const Outcome refused = run("zwidth design refused.toml --recommend --json");
  EXPECT_EQ(refused.status, 0);
  EXPECT_TRUE(nlohmann::json::parse(refused.output)["wall"].is_null());
}

TEST_F(DesignRecommend, RefusesWhatItCannotMean) {
  expect_refusal("zwidth design devices/lhifam.toml --recommend --goal any-user",
                 "--goal: any-user is not for a recommendation");
  expect_refusal("zwidth design devices/lhifam.toml --recommend --notch", "--recommend: excludes --notch");
  expect_refusal("zwidth design devices/lhifam.toml --recommend --ripple 0", "--ripple: devices/lhifam.toml: is 0");
  expect_refusal("zwidth design devices/lhifam.toml --ripple 0.1", "add --recommend");
  expect_refusal("zwidth design devices/lhifam.toml --recommend --drift-percent 95", "--drift-percent");
  expect_refusal("zwidth design devices/emps.toml --recommend --drift-percent 3", "there is no link");
}

}  // namespace
}  // namespace zwidth::cli
