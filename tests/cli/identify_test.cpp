#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const std::string record = "zwidth identify recordings/locked_chirp.csv --force force --position position ";
const std::string locked =
    record + "--structure devices/lhifam.toml --locked handle --free link.stiffness,link.damping ";

long lines_of_findings(const std::string& text) {
  std::istringstream lines(text);
  long count = 0;
  for (std::string line; std::getline(lines, line);)
    count += line.starts_with("  ! ") || line.starts_with("  - ") ? 1 : 0;
  return count;
}

class Identify : public Workspace {
 protected:
  [[nodiscard]] json document(const std::string& command) const {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, 0) << command << "\n" << outcome.errors;
    EXPECT_THAT(outcome.errors, IsEmpty()) << command;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << command;
    return json::parse(outcome.output, nullptr, false);
  }
};

// The recording is of the paper's Table I (79.5 kN/m, 15 N s/m): recordings/README.md.
TEST_F(Identify, FindsTheCableOfTheExample) {
  EXPECT_THAT(run(locked).output, HasSubstr("Trust: sound."));
  const json found = document(locked + "--json");
  EXPECT_EQ(found["schema"], "zwidth.identification/1");
  ASSERT_EQ(found["parameters"].size(), 2U);
  EXPECT_EQ(found["parameters"][0]["key"], "link.0.stiffness");
  EXPECT_NEAR(found["parameters"][0]["value"], 79.5e3, 795.0);
  EXPECT_NEAR(found["parameters"][1]["value"], 15.0, 0.75);
  EXPECT_EQ(found["parameters"][0]["unit"], "N/m");
  EXPECT_LT(found["critical_stiffness_interval"][0], 8848.7);
  EXPECT_NEAR(found["critical_stiffness"], 8848.7, 10.0);
  EXPECT_FALSE(found["held_to_measured_critical_point"]);
  EXPECT_TRUE(found["critical_stiffness_without_hold"].is_null());
  EXPECT_FALSE(found.contains("points"));
  const json with_points = document(locked + "--json --points");
  EXPECT_EQ(with_points["points"]["frequency_hz"].size(), found["point_count"]);
  EXPECT_EQ(with_points["points"]["fitted"].size(), found["point_count"]);
}

TEST_F(Identify, WritesAFileThatAnalyzeTakesWithItsInterval) {
  const Outcome outcome = run(locked + "--output-device fitted.toml");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("The device is in fitted.toml"));
  const json analysis = document("zwidth analyze fitted.toml --json");
  EXPECT_NEAR(analysis["critical_stiffness"], 8848.7, 10.0);
  ASSERT_TRUE(analysis["critical_stiffness_interval"].is_array());
  EXPECT_LT(analysis["critical_stiffness_interval"][0], analysis["critical_stiffness"]);
  EXPECT_GT(analysis["critical_stiffness_interval"][1], analysis["critical_stiffness"]);
  EXPECT_EQ(analysis["other_mechanism_share"], 0.0);
  EXPECT_THAT(run("zwidth analyze fitted.toml").output, HasSubstr("95 % interval"));
  EXPECT_TRUE(document("zwidth analyze devices/lhifam.toml --json")["critical_stiffness_interval"].is_null());
}

TEST_F(Identify, WritesTheDeviceToStandardOutput) {
  const json piped = document(locked + "--output-device - | zwidth analyze - --json");
  EXPECT_NEAR(piped["critical_stiffness"], 8848.7, 10.0);
}

TEST_F(Identify, DrawsDataAndFit) {
  EXPECT_EQ(run(locked + "--figure fit.svg").status, 0);
  const std::string figure = contents("fit.svg");
  EXPECT_THAT(figure, HasSubstr("Residual (σ)"));
  EXPECT_THAT(figure, HasSubstr("residual of the phase"));
}

TEST_F(Identify, NamesWhatTheDataLeaveOpen) {
  const Outcome outcome = run(record + "--structure two-body --locked handle --explain");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("only a combination of body.motor.damping, link.0.damping"));
  EXPECT_THAT(outcome.output, HasSubstr("is a placeholder"));
  const Outcome brief = run(record + "--structure two-body --locked handle");
  EXPECT_THAT(brief.output, HasSubstr("DOUBTFUL"));
  EXPECT_THAT(brief.output, HasSubstr(": add --explain\n"));
  EXPECT_EQ(lines_of_findings(brief.output), 3);
  EXPECT_GT(lines_of_findings(outcome.output), 3);
  const json found = document(record + "--structure two-body --locked handle --json");
  EXPECT_EQ(found["unidentifiable"], json::parse(R"([["body.motor.damping", "link.0.damping"]])"));
  EXPECT_NEAR(found["parameters"][0]["value"], 0.3, 0.003);
  EXPECT_TRUE(found["parameters"][1]["interval"].is_null());
}

TEST_F(Identify, SetsKeysOfTheStructure) {
  const json heavier = document(locked + "--set body.motor.damping=1.1 --json");
  EXPECT_NEAR(heavier["parameters"][1]["value"], 14.0, 0.7);  // the sum of the two is what shows
}

TEST_F(Identify, RefusesWhatItCannotUse) {
  expect_refusal(record, "--structure: missing");
  expect_refusal(record + "--structure nowhere.toml", "--structure: nowhere.toml: cannot be read");
  expect_refusal(record + "--structure two-body --locked hndle", "did you mean handle?");
  expect_refusal(record + "--structure two-body --locked motor", "the actuated body \"motor\" is locked");
  expect_refusal(record + "--structure two-body --free link.stifness", "did you mean link.0.stiffness?");
  expect_refusal(record + "--structure two-body --free wall.damping", "does not show in a frequency response");
  expect_refusal(record + "--structure devices/lhifam.toml --motion rotary", "--motion: is for a named structure");
  for (const char* structure : {"two-body", "devices/lhifam.toml"}) {
    const std::string named = record + "--structure " + structure;
    expect_refusal(named + " --sampling-period 1e40", "--sampling-period: is 1e+40 s; must be from 1e-30 to 1e+30");
  }
  expect_refusal(record + "--structure two-body --sampling-period 0", "--sampling-period: is 0");
  expect_refusal(record + "--structure devices/lhifam.toml --sampling-period 0", "--sampling-period: is 0");
  expect_refusal(locked + "--figure fit.bmp", "unknown extension");
  expect_refusal(locked + "--json --output-device -", "standard output, which --json takes");
  expect_refusal(locked + "--output-device recordings/locked_chirp.csv", "would overwrite the recording");
  expect_refusal(locked + "--output-device devices/lhifam.toml", "would overwrite the structure");
  expect_refusal(locked + "--output-device a.svg --figure a.svg", "is the same file as that of --output-device");
  expect_refusal("zwidth identify recordings/locked_chirp.csv --structure two-body --force force --acceleration force",
                 "column 'force' is named as the force and as the motion");
  expect_refusal(locked + "--highest-hz 12 --lowest-hz 11.9", "");
}

// A record that nobody here made, and a structure of which nothing is known.
TEST_F(Identify, FitsTheMotorBench) {
  const std::string file = std::string(ZWIDTH_SHARED_DIR) + "/data/two_mass_bench/MultisineTypeA.mat";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "needs ../shared/data/two_mass_bench/MultisineTypeA.mat";
  const json found = document("zwidth identify '" + file +
                              "' --force iq_refx --position theta_mx --rate 2500 --period 2500 --skip-periods 3 "
                              "--structure two-body --motion rotary --free all,loop.delay,actuator.time_constant "
                              "--output-device fitted.toml --json");
  const json analysis = document("zwidth analyze fitted.toml --json");
  EXPECT_NEAR(analysis["critical_stiffness"], 301.7, 0.05 * 301.7);
  EXPECT_EQ(analysis["limited_by"]["kind"], "vibration_mode");
  EXPECT_EQ(analysis["limited_by"]["mode"], 1);
  EXPECT_NEAR(analysis["modes"][0]["frequency_hz"], 76.5, 1.0);
  EXPECT_TRUE(found["held_to_measured_critical_point"]);
}

// The example's position one sample late, fitted without a delay.
TEST_F(Identify, AnUnsafeFitOfALockedDeviceSaysSoForGood) {
  const Outcome fit =
      run("awk -F, 'NR == 1 { print; next } NR > 2 { print $1 \",\" $2 \",\" late } { late = $3 }' "
          "recordings/locked_chirp.csv "
          "> late.csv && zwidth identify late.csv --force 2 --position 3 --structure devices/lhifam.toml "
          "--free link.stiffness,link.damping --locked handle --output-device late.toml");
  ASSERT_EQ(fit.status, 0) << fit.errors;
  EXPECT_THAT(fit.output, HasSubstr("UNSAFE: the critical stiffness of the recorded device as fitted"));
  const Outcome analysis = run("zwidth analyze late.toml");
  EXPECT_EQ(analysis.status, 0) << analysis.errors;
  EXPECT_THAT(analysis.output, HasSubstr("UNSAFE"));
  EXPECT_THAT(document("zwidth analyze late.toml --json")["uncertainty_warning"].get<std::string>(),
              HasSubstr("UNSAFE"));
}

TEST_F(Identify, WhatTheDataDoNotDetermineStaysInTheFile) {
  const std::string fit =
      "zwidth identify recordings/locked_chirp.csv --force force --position position --structure two-body --locked "
      "handle --output-device ";
  ASSERT_EQ(run(fit + "guess.toml").status, 0);
  ASSERT_EQ(run(fit + "guess_in_time.toml --method time-domain").status, 0);
  // Of the body held still the record shows nothing: its numbers are assumed until somebody gives them.
  const json unseen = json::parse(R"(["body.handle.mass", "body.handle.damping"])");
  for (const char* file : {"guess.toml", "guess_in_time.toml"}) {
    const json found = document(fmt::format("zwidth analyze {} --json", file));
    EXPECT_EQ(found["assumed"], unseen) << file;
    EXPECT_EQ(found["trust"]["verdict"], "doubtful") << file;
    EXPECT_THAT(found["trust"]["reasons"].dump(),
                HasSubstr("assumed, not measured: body.handle.mass, body.handle.damping"));
  }
  // What the data leave open is another matter: it takes another fit.
  const std::string warning = document("zwidth analyze guess.toml --json")["uncertainty_warning"].get<std::string>();
  EXPECT_THAT(warning, HasSubstr("do not determine body.motor.damping, link.0.damping: taken"));
}

}  // namespace
}  // namespace zwidth::cli
