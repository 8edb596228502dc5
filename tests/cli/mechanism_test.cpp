// The program on a device of a mechanism, against closed-loop eigenvalues (tests/reference/README.md).
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using nlohmann::json;

class MechanismOfProgram : public Workspace {
 protected:
  [[nodiscard]] json analysed(const json& reference, const std::string& normal) const {
    const Outcome outcome = run(
        fmt::format("zwidth analyze devices/mechanisms/planar_arm.toml --json --set mechanism.pose.shoulder={} --set "
                    "mechanism.pose.elbow={} --set loop.delay={} --set 'mechanism.normal={}'",
                    reference["pose"][0].dump(), reference["pose"][1].dump(), reference["delay"].dump(), normal));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return json::parse(outcome.output);
  }
};

bool has_finding(const json& document, const std::string& code) {
  return std::ranges::any_of(document["findings"], [&](const json& each) { return each["code"] == code; });
}

json references() {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/tests/reference/planar_arm.json");
  return json::parse(file);
}

TEST_F(MechanismOfProgram, LimitsAlongEveryNormalWithNobodyAndWithAnyPassiveUser) {
  int normals = 0;
  int any_users = 0;
  for (const json& each : references()) {
    if (each["normal"].is_null()) continue;
    ++normals;
    SCOPED_TRACE(each.dump());
    const json found = analysed(each, fmt::format("[{},{},0]", each["normal"][0].dump(), each["normal"][1].dump()));
    EXPECT_NEAR(found["critical_stiffness"].get<double>() / each["critical_stiffness"].get<double>(), 1.0, 1e-8);
    EXPECT_EQ(found["limits"]["any_user"]["critical_stiffness"], found["any_user"]["critical_stiffness"]);
    EXPECT_TRUE(has_finding(found, "any_grasp_scanned"));
    EXPECT_LE(found["any_user"]["critical_stiffness"], found["critical_stiffness"]);
    if (!each.contains("any_user")) continue;
    ++any_users;
    EXPECT_NEAR(
        found["any_user"]["critical_stiffness"].get<double>() / each["any_user"]["critical_stiffness"].get<double>(),
        1.0, 1e-5);
  }
  EXPECT_EQ(normals, 36);
  EXPECT_EQ(any_users, 9);
}

TEST_F(MechanismOfProgram, APointWallOfEveryPose) {
  int points = 0;
  for (const json& each : references()) {
    if (!each["normal"].is_null()) continue;
    ++points;
    SCOPED_TRACE(each.dump());
    const json found = analysed(each, "\"all\"");
    EXPECT_EQ(found["schema"], "zwidth.analysis/1");
    EXPECT_NEAR(found["critical_stiffness"].get<double>() / each["critical_stiffness"].get<double>(), 1.0, 1e-8);
    EXPECT_GT(found["critical_frequency_rad_s"].get<double>(), 0.0);
    EXPECT_EQ(found["point_wall"]["direction"].size(), 3U);
    EXPECT_LE(found["point_wall"]["any_user"]["at_least"], found["point_wall"]["any_user"]["at_most"]);
    EXPECT_TRUE(found["any_user"].is_null());
    EXPECT_TRUE(found["limits"]["any_user"].is_null());
    EXPECT_TRUE(has_finding(found, "any_grasp_bounded"));
  }
  EXPECT_EQ(points, 6);
}

TEST_F(MechanismOfProgram, RefusesAPointWallButForItsAnalysisAndRegion) {
  const std::string file = "devices/mechanisms/planar_arm.toml --set mechanism.normal=all";
  for (const char* command : {"bode", "bode --json", "design", "design --json", "design --recommend",
                              "design --target 2x", "simulate", "diagnose --oscillates-hz 8", "relay --amplitude 1",
                              "export --format json", "export --format octave", "export --format c", "rig check"}) {
    SCOPED_TRACE(command);
    expect_refusal(fmt::format("zwidth {} {}", command, file), "mechanism.normal");
  }
  EXPECT_TRUE(
      run("zwidth bode " + file).errors.starts_with("zwidth: devices/mechanisms/planar_arm.toml: mechanism.normal"));
  const Outcome text = run("zwidth analyze " + file);
  EXPECT_EQ(text.status, 0) << text.errors;
  EXPECT_NE(text.output.find("at least"), std::string::npos);
  expect_refusal(fmt::format("zwidth analyze {} --report page.html", file), "--report");
}

TEST_F(MechanismOfProgram, RegionOfAPointWall) {
  const json region =
      json::parse(run("zwidth region devices/mechanisms/planar_arm.toml --set mechanism.normal=all --json").output);
  const json analysis =
      json::parse(run("zwidth analyze devices/mechanisms/planar_arm.toml --set mechanism.normal=all --json").output);
  EXPECT_EQ(region["status"], "bounded");
  EXPECT_EQ(region["trust"]["verdict"], "sound");
  EXPECT_NEAR(region["critical_stiffness"].get<double>() / analysis["critical_stiffness"].get<double>(), 1.0, 1e-8);
  EXPECT_TRUE(region["any_user"].is_null());
  EXPECT_TRUE(region["approximations"].empty());
  EXPECT_TRUE(has_finding(region, "boundary_sampled"));
  EXPECT_TRUE(has_finding(region, "any_grasp_not_known"));
}

TEST_F(MechanismOfProgram, EveryCommandAnswersAlongANormal) {
  const std::string arm = "devices/mechanisms/planar_arm.toml";
  const auto answered = [&](const std::string& command) {
    const Outcome outcome = run("zwidth " + command + " --json");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return json::parse(outcome.output, nullptr, false);
  };
  const json slopes = answered("design " + arm);
  EXPECT_NEAR(slopes["critical_stiffness"].get<double>(), 318.9, 0.1);
  bool has_elbow = false;
  for (const json& each : slopes["sensitivities"]) {
    if (each["parameter"] != "mechanism.pose.elbow") continue;
    has_elbow = true;
    EXPECT_EQ(each["unit"], "rad");
    EXPECT_LT(each["slope"].get<double>(), 0.0);
    EXPECT_LT(each["any_user_slope"].get<double>(), 0.0);
    EXPECT_TRUE(each["relative"].is_null());
  }
  EXPECT_TRUE(has_elbow);
  const json targets = answered("design " + arm + " --target \"120 %\"");
  for (const json& each : targets["targets"]) {
    EXPECT_TRUE(each["value_needed"].is_null() || each["safe"].is_boolean()) << each;
  }
  const json wall = answered("design " + arm + " --recommend");
  EXPECT_EQ(wall["trust"]["verdict"], "sound");
  EXPECT_TRUE(has_finding(wall, "any_grasp_scanned"));
  EXPECT_GT(wall["wall"]["stiffness"].get<double>(), 0.0);
  const json cause = answered("diagnose " + arm + " --oscillates-hz 8.5 --stiffness 350");
  EXPECT_EQ(cause["cause"], "device");
  for (const json& each : cause["changes"]) EXPECT_TRUE(each["safe"].is_boolean()) << each;
  const json region = answered("region " + arm);
  EXPECT_TRUE(has_finding(region, "any_grasp_scanned"));
  EXPECT_FALSE(region["any_user"].is_null());
  const json sweep = answered("design " + arm + " --sweep \"mechanism.pose.elbow=20 deg:60 deg:3\" --any-user");
  EXPECT_EQ(sweep["axes"][0]["unit"], "rad");
  EXPECT_NEAR(sweep["axes"][0]["values"][2].get<double>(), 1.0471975511965976, 1e-12);
  const json relay = answered("relay " + arm + " --amplitude 1 --duration 2 --trials 1");
  EXPECT_NEAR(relay["predictions"]["critical"]["stiffness"].get<double>(), 318.9, 0.1);
}

}  // namespace
}  // namespace zwidth::cli
