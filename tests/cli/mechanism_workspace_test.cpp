// `zwidth workspace` on the planar arm: against analyze pose by pose, and against the library byte for byte.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cli/same_answer.hpp"
#include "results/workspace_json.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/workspace.hpp"

namespace zwidth::cli {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const std::string arm_file = "devices/mechanisms/planar_arm.toml";
const std::string pose_grid = " --poses 'shoulder=0:60:2 deg,elbow=30:120:2 deg'";
const std::string wall_normals = " --normals '1,0,0;0,1,0'";

class MechanismWorkspace : public SameAnswer {
 protected:
  [[nodiscard]] json asked(const std::string& options) const {
    const Outcome outcome = run("zwidth workspace " + arm_file + options + " --json");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_THAT(outcome.errors, IsEmpty());
    return json::parse(outcome.output);
  }

  [[nodiscard]] json analysed(const json& pose, const json& normal) const {
    const Outcome outcome =
        run(fmt::format("zwidth analyze {} --json --set mechanism.pose.shoulder={} --set mechanism.pose.elbow={} --set "
                        "'mechanism.normal={}'",
                        arm_file, pose[0].dump(), pose[1].dump(), normal.dump()));
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return json::parse(outcome.output);
  }
};

std::vector<std::string> codes_of(const json& document) {
  std::vector<std::string> codes;
  for (const json& each : document["findings"]) codes.push_back(each["code"]);
  return codes;
}

double quotient(const json& one, const json& other) { return one.get<double>() / other.get<double>(); }

TEST_F(MechanismWorkspace, AnswersAtEveryPoseAsAnalyzeDoes) {
  const json found = asked(pose_grid + wall_normals + " --all-directions");
  EXPECT_EQ(found["schema"], "zwidth.workspace/1");
  EXPECT_EQ(found["joints"], json::parse(R"([{"name":"shoulder","unit":"rad"},{"name":"elbow","unit":"rad"}])"));
  ASSERT_EQ(found["poses"].size(), 4U);
  double least = INFINITY;
  double least_any_user = INFINITY;
  for (const json& pose : found["poses"]) {
    SCOPED_TRACE(pose["pose"].dump());
    EXPECT_TRUE(pose["problem"].is_null());
    ASSERT_EQ(pose["directions"].size(), 2U);
    for (const json& each : pose["directions"]) {
      const json there = analysed(pose["pose"], each["normal"]);
      EXPECT_EQ(each["status"], there["status"]);
      EXPECT_NEAR(quotient(each["nobody"], there["critical_stiffness"]), 1.0, 1e-8);
      EXPECT_NEAR(quotient(each["any_user"], there["any_user"]["critical_stiffness"]), 1.0, 1e-4);
      least = std::min(least, each["nobody"].get<double>());
      least_any_user = std::min(least_any_user, each["any_user"].get<double>());
    }
  }
  EXPECT_NEAR(found["least"]["value"].get<double>() / least, 1.0, 1e-8);
  EXPECT_NEAR(found["least_any_user"]["value"].get<double>() / least_any_user, 1.0, 1e-4);
  EXPECT_EQ(found["directions"], 8);
  EXPECT_EQ(found["refused_poses"], 0);
  EXPECT_THAT(codes_of(found), ::testing::Contains("any_grasp_scanned"));
  const json last = found["poses"][3]["pose"];
  EXPECT_NEAR(last[0].get<double>(), std::numbers::pi / 3.0, 1e-15);
  EXPECT_NEAR(last[1].get<double>(), 2.0 * std::numbers::pi / 3.0, 1e-15);
}

TEST_F(MechanismWorkspace, TheWorstPoseIsADeviceWithThatLimit) {
  const json found = asked(pose_grid + " --worst-to worst.toml");
  const Outcome outcome = run("zwidth analyze worst.toml --json");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const json there = json::parse(outcome.output);
  EXPECT_NEAR(quotient(there["any_user"]["critical_stiffness"], found["least_any_user"]["value"]), 1.0, 1e-9);
  EXPECT_EQ(there["trust"]["verdict"], found["trust"]["verdict"]);
  EXPECT_THAT(contents("worst.toml"), HasSubstr("file = \"devices/mechanisms/planar_arm.xml\""));
  // Of a file that lies elsewhere the whole path.
  std::filesystem::create_directory(directory() / "apart");
  ASSERT_EQ(run("zwidth workspace " + arm_file + pose_grid + " --worst-to apart/worst.toml").status, 0);
  const Outcome apart = run("cd apart && zwidth analyze worst.toml --json");
  EXPECT_EQ(apart.output, outcome.output) << apart.errors;
}

TEST_F(MechanismWorkspace, GoesWithTheTipToPointsAndSaysWhichItDoesNotReach) {
  const json found = asked(" --points 0.3,0.2,0 '350,100,0 mm; 2,0,0'" + wall_normals);
  ASSERT_EQ(found["poses"].size(), 2U);
  const double expected[2][2] = {{0.3, 0.2}, {0.35, 0.1}};
  for (std::size_t i = 0; i < 2; ++i) {
    const json& pose = found["poses"][i];
    EXPECT_EQ(pose["point"], i);
    EXPECT_NEAR(pose["tip"][0].get<double>(), expected[i][0], 1e-8);
    EXPECT_NEAR(pose["tip"][1].get<double>(), expected[i][1], 1e-8);
    EXPECT_TRUE(pose["least"].is_object());
  }
  ASSERT_EQ(found["unreached"].size(), 1U);
  EXPECT_EQ(found["unreached"][0]["point"], 2);
  EXPECT_NEAR(found["unreached"][0]["short_of"].get<double>(),
              2.0 - std::sqrt(0.1025 + 0.1 * std::cos(std::numbers::pi / 9.0)), 1e-3);
  EXPECT_THAT(codes_of(found), ::testing::Contains("workspace_points_not_reached"));
}

TEST_F(MechanismWorkspace, SaysWhereNothingIsKnown) {
  const json found = asked(" --poses shoulder=0,elbow=0:0.5:2 --normals '1,0,0;0,1,0'");
  ASSERT_EQ(found["poses"].size(), 2U);
  const json& stretched = found["poses"][0];  // the tip cannot move along the arm
  EXPECT_TRUE(!stretched["problem"].is_null() || stretched["refused_directions"].size() == 1U) << stretched.dump();
  EXPECT_TRUE(found["poses"][1]["problem"].is_null());
  EXPECT_GT(found["refused_poses"].get<int>() + found["refused_directions"].get<int>(), 0);
}

TEST_F(MechanismWorkspace, QuantilesAndShareAreThoseOfItsDirections) {
  const json found = asked(pose_grid + wall_normals + " --stiffness '0.4 kN/m' --all-directions");
  std::vector<double> limits;
  for (const json& pose : found["poses"]) {
    for (const json& each : pose["directions"]) limits.push_back(each["nobody"]);
  }
  std::ranges::sort(limits);
  const json& quantiles = found["quantiles"];
  EXPECT_EQ(quantiles.front()["probability"], 0.0);
  EXPECT_EQ(quantiles.front()["nobody"], limits.front());
  EXPECT_EQ(quantiles.back()["nobody"], limits.back());
  const auto reached = std::ranges::count_if(limits, [](double each) { return each >= 400.0; });
  EXPECT_EQ(found["share_at_least"]["stiffness"], 400.0);
  EXPECT_DOUBLE_EQ(found["share_at_least"]["nobody"], static_cast<double>(reached) / 8.0);
  EXPECT_TRUE(asked(pose_grid + wall_normals)["share_at_least"].is_null());
}

TEST_F(MechanismWorkspace, WritesARowForEveryPoseAndDirection) {
  const json found = asked(pose_grid + wall_normals + " --csv map.csv --all-directions");
  std::istringstream rows(contents("map.csv"));
  std::string row;
  std::getline(rows, row);
  EXPECT_THAT(row, StartsWith("pose,shoulder (rad),elbow (rad),tip_x_m,tip_y_m,tip_z_m,normal_x,"));
  std::size_t count = 0;
  while (std::getline(rows, row)) {
    const json& pose = found["poses"][count / 2];
    EXPECT_THAT(row, StartsWith(fmt::format("{},", count / 2 + 1)));
    EXPECT_THAT(row,
                HasSubstr(",finite," + fmt::format("{:.17g}", pose["directions"][count % 2]["nobody"].get<double>())));
    ++count;
  }
  EXPECT_EQ(count, 8U);
}

TEST_F(MechanismWorkspace, IsTheLibrarysAnswerByteForByteWhateverTheThreads) {
  const auto answer = [this](const WorkspaceOptions& options, results::DirectionsInJson directions) {
    const Device device = *read_device_file((directory() / arm_file).string());
    const zwidth::Workspace found = workspace(device, options);
    return Answer{results::line(results::workspace_json(device, found, directions)) + results::workspace_csv(found)};
  };
  const WorkspaceOptions of_grid{.grid = {{.joint = "shoulder", .first = 0.0, .last = 1.0, .count = 2},
                                          {.joint = "elbow", .first = 0.5, .last = 2.0, .count = 2}},
                                 .directions = 5,
                                 .stiffness = 300.0,
                                 .threads = 2};
  const WorkspaceOptions of_points{.points = {{0.3, 0.2, 0.0}}, .normals = {{1.0, 0.0, 0.0}, {0.0, 2.0, 0.0}}};
  const std::string command = "workspace " + arm_file + " --json";
  expect_same({{command + " --poses shoulder=0:1:2,elbow=0.5:2:2 --normals 5 --stiffness 300 --threads 1 --csv a.csv",
                [&] { return answer(of_grid, results::DirectionsInJson::left_out); }, "a.csv"},
               {command + " --points 0.3,0.2,0 --normals 1,0,0 --normals 0,2,0 --all-directions --csv b.csv",
                [&] { return answer(of_points, results::DirectionsInJson::included); }, "b.csv"}});
}

TEST_F(MechanismWorkspace, KeepsTheWallsDamperAndItsFilter) {
  const std::string wall = " --set wall.damping=5 --set wall.velocity_filter_hz=30";
  const json found = asked(" --poses shoulder=0.3,elbow=1.2 --normals 1,0,0" + wall);
  const Outcome outcome = run("zwidth analyze " + arm_file + " --json --set mechanism.pose.elbow=1.2" + wall);
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const json there = json::parse(outcome.output);
  EXPECT_NEAR(quotient(found["least"]["value"], there["critical_stiffness"]), 1.0, 1e-12);
  EXPECT_NEAR(quotient(found["least_any_user"]["value"], there["any_user"]["critical_stiffness"]), 1.0, 1e-12);
}

TEST_F(MechanismWorkspace, TakesAPointWallsFile) {
  const json found = asked(pose_grid + wall_normals + " --set mechanism.normal=all");
  EXPECT_EQ(found["least"], asked(pose_grid + wall_normals)["least"]);
}

TEST_F(MechanismWorkspace, RefusesWhatItCannotRead) {
  const std::string of_arm = "zwidth workspace " + arm_file;
  for (const char* poses : {"shoulder",
                            "=0:1:2",
                            "shoulder=",
                            "shoulder=0:1",
                            "shoulder=0:1:2:3",
                            "shoulder=0:1:x",
                            "shoulder=0:1:2.5",
                            "shoulder=0:1:-2",
                            "shoulder=0:1:2 kg",
                            "shoulder=0:1:2 mm",
                            "shoulder=a:1:2",
                            "'shoulder=0 deg:1 mm:2'",
                            "shoulder=nan:1:2",
                            "shoulder=0:1:0",
                            "shoulder=0:1:2,",
                            "shoulder=0:1:2,shoulder=0:1:2",
                            "knee=0:1:2",
                            "shoulder=0:1:1e9",
                            "shoulder=0:1:99999999999999999999",
                            "shoulder=0:1:4000,elbow=0:1:4000"}) {
    SCOPED_TRACE(poses);
    expect_refusal(
        fmt::format("{} --poses {}", of_arm, std::string(poses).front() == '\'' ? poses : fmt::format("'{}'", poses)),
        "--poses");
  }
  for (const char* points :
       {"0.3", "0.3,0.2", "0.3,0.2,0,0", "a,0,0", "0.3,0.2,inf", "0.3,0.2,0 kg", ";", "1e31,0,0"}) {
    SCOPED_TRACE(points);
    expect_refusal(fmt::format("{} --points '{}'", of_arm, points), "--points");
  }
  for (const char* normals :
       {"0,0,0", "1,0", "1,0,x", "0", "-3", "2.5", "1e9", "nan", "1,0,0;", "1,0,0 m", "99999999999"}) {
    SCOPED_TRACE(normals);
    expect_refusal(fmt::format("{}{} --normals '{}'", of_arm, pose_grid, normals), "--normals");
  }
  for (const char* stiffness : {"0", "-1", "nan", "'3 N m/rad'", "x"}) {
    SCOPED_TRACE(stiffness);
    expect_refusal(fmt::format("{}{} --stiffness {}", of_arm, pose_grid, stiffness), "--stiffness");
  }
  expect_refusal(of_arm + pose_grid + " --points 0.3,0.2,0", "poses");
  expect_refusal("zwidth workspace devices/lhifam.toml", "lhifam.toml");
  expect_refusal(of_arm + pose_grid + " --worst-to " + arm_file, "--worst-to");
  expect_refusal(of_arm + pose_grid + " --csv devices/mechanisms/planar_arm.xml", "--csv");
  expect_refusal(of_arm + pose_grid + " --csv a.csv --worst-to a.csv", "--worst-to");
  expect_refusal(of_arm + pose_grid + " --threads 100000", "--threads");
}

TEST_F(MechanismWorkspace, AListOfPosesHasUnits) {
  const json in_degrees = asked(wall_normals + " --poses 'shoulder=0,elbow=40 deg; shoulder=30 deg,elbow=60 deg'");
  const json grid = asked(wall_normals + " --poses 'shoulder=0,elbow=40 deg'");
  ASSERT_EQ(in_degrees["poses"].size(), 2U);
  EXPECT_EQ(in_degrees["poses"][0]["least"]["value"], grid["poses"][0]["least"]["value"]);
  EXPECT_DOUBLE_EQ(in_degrees["poses"][1]["pose"][0].get<double>(), std::numbers::pi / 6.0);
}

TEST_F(MechanismWorkspace, WritesAPage) {
  const Outcome outcome = run("zwidth workspace " + arm_file + pose_grid + " --normals 3 --report page.html");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  const std::string page = contents("page.html");
  for (const char* part : {"<!DOCTYPE html>", "<svg", "class=\"value\"", "<h2>Poses with the least limits</h2>"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
  expect_refusal("zwidth workspace " + arm_file + pose_grid + " --report page.png", "--report");
  const Outcome refused =
      run("zwidth workspace " + arm_file + pose_grid + " --set uncertainty.verdict=refused --report none.html");
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(contents("none.html"), IsEmpty());
}

TEST_F(MechanismWorkspace, IsTrustedNoMoreThanItsDevice) {
  const std::string files = " --csv map.csv --worst-to worst.toml";
  const std::string doubt = pose_grid + wall_normals + " --set uncertainty.verdict=doubtful";
  EXPECT_EQ(asked(doubt + files)["trust"]["verdict"], "doubtful");
  EXPECT_THAT(contents("map.csv"), HasSubstr(",doubtful\n"));
  EXPECT_THAT(contents("worst.toml"), HasSubstr("verdict = \"doubtful\""));
  const std::string refusal = pose_grid + wall_normals + " --set uncertainty.verdict=refused";
  const json refused = asked(refusal);
  EXPECT_EQ(refused["trust"]["verdict"], "refused");
  EXPECT_TRUE(refused["least"].is_null());
  for (const char* file : {" --csv none.csv", " --worst-to none.csv"}) {
    EXPECT_EQ(run("zwidth workspace " + arm_file + refusal + file).status, 1) << file;
    EXPECT_THAT(contents("none.csv"), IsEmpty());
  }
}

TEST_F(MechanismWorkspace, WritesAllFilesOrNone) {
  const Outcome outcome = run("zwidth workspace " + arm_file + pose_grid + wall_normals +
                              " --csv no/such/folder.csv --worst-to worst.toml");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.output, IsEmpty());
  EXPECT_THAT(contents("worst.toml"), IsEmpty());
}

TEST_F(MechanismWorkspace, TextBeginsWithTheDeviceAndNamesThePosesOfItsTable) {
  const Outcome outcome = run("zwidth workspace " + arm_file + pose_grid + " --stiffness 300");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, StartsWith("Planar arm, two cables\n"));
  EXPECT_THAT(outcome.output, HasSubstr(" deg, elbow 30 deg\n"));
  const auto lines = std::count(outcome.output.begin(), outcome.output.end(), '\n');
  EXPECT_GT(lines, 20);
  const Outcome one = run("zwidth workspace " + arm_file + " --points 0.3,0.2,0 --normals 1,0,0");
  EXPECT_EQ(one.status, 0) << one.errors;
  EXPECT_LT(std::count(one.output.begin(), one.output.end(), '\n'), lines);
}

}  // namespace
}  // namespace zwidth::cli
