#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cli/workspace.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth::cli {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class Simulate : public Workspace {
 protected:
  [[nodiscard]] nlohmann::json json_of(const std::string& arguments) const {
    const Outcome outcome = run("zwidth simulate " + arguments + " --json");
    EXPECT_EQ(outcome.status, 0) << arguments << "\n" << outcome.errors;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << outcome.output;
    return nlohmann::json::parse(outcome.output, nullptr, false);
  }
  void expect_refused(const std::string& arguments, const std::string& message) const {
    expect_refusal("zwidth simulate " + arguments, message);
  }
};

const std::string lhifam = "devices/lhifam.toml --set wall.stiffness=5000 ";

// Without the last column, `trust`.
std::vector<std::vector<double>> rows_of(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::vector<std::vector<double>> rows;
  while (std::getline(lines, line)) {
    std::istringstream cells(line.substr(0, line.rfind(',')));
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(std::stod(cell));
  }
  return rows;
}

TEST_F(Simulate, SaysWhatTheLoopDidWithNumbersAndUnits) {
  const Outcome outcome = run("zwidth simulate " + lhifam);
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, IsEmpty());
  EXPECT_THAT(outcome.output, HasSubstr("SETTLES: the oscillation dies out"));
  EXPECT_THAT(outcome.output, HasSubstr("peak penetration    1 mm"));
  EXPECT_THAT(outcome.output, HasSubstr("critical stiffness with nobody holding: 8.849 kN/m"));
  EXPECT_THAT(outcome.output, HasSubstr("56.5 % of it"));
  std::istringstream lines(run("COLUMNS=100 zwidth simulate " + lhifam).output);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 110U) << line;
}

TEST_F(Simulate, TheVerdictFollowsTheCriticalStiffness) {
  EXPECT_EQ(json_of("devices/lhifam.toml --set wall.stiffness=8000 --duration 20").at("verdict"), "settles");
  const auto above = json_of("devices/lhifam.toml --set wall.stiffness=9800 --duration 20");
  EXPECT_EQ(above.at("verdict"), "unstable");
  EXPECT_GT(above.at("growth_rate_per_s"), 0.0);
  EXPECT_EQ(above.at("linear").at("wall_stable"), false);
  EXPECT_NEAR(above.at("linear").at("critical_stiffness").get<double>(), 8848.70869499712, 1e-6);
}

TEST_F(Simulate, JsonHasEveryKeyAndNullForWhatDoesNotExist) {
  const auto moving = json_of(lhifam + "--duration 2");
  EXPECT_EQ(moving.at("schema"), "zwidth.simulation/1");
  EXPECT_EQ(moving.at("samples"), 2000);
  EXPECT_EQ(moving.at("units").at("force"), "N");
  EXPECT_TRUE(moving.at("user_force").is_null());
  EXPECT_EQ(moving.at("start").at(1).at("body"), "handle");
  EXPECT_EQ(moving.at("start").at(1).at("position"), 1e-3);
  const auto free = json_of("devices/lhifam.toml --start-velocity 0.1 --duration 2");
  EXPECT_EQ(free.at("verdict"), "drifts");
  for (const char* key : {"wall", "peak_penetration", "generated_energy", "peak_generated_energy", "oscillation",
                          "growth_rate_per_s", "settling_time_s"}) {
    EXPECT_TRUE(free.at(key).is_null()) << key;
  }
  EXPECT_TRUE(free.at("linear").at("wall_stable").is_null());
  EXPECT_THAT(free.at("remarks").at(0).at("what").get<std::string>(), HasSubstr("no wall"));
}

TEST_F(Simulate, CsvIsTheLibrarysMotion) {
  ASSERT_EQ(run("zwidth simulate " + lhifam +
                "--start motor=1e-3 --start handle=-2e-3 --start-velocity handle=0.1 "
                "--user-force sine:5,3Hz@0.0205 --duration 0.5 --csv a.csv")
                .status,
            0);
  EXPECT_THAT(contents("a.csv"), StartsWith("time_s,measured,command,user_force,motor.position,motor.velocity,"
                                            "handle.position,handle.velocity,trust\n"));
  const auto rows = rows_of(contents("a.csv"));
  ASSERT_EQ(rows.size(), 500U);
  const Device device = *read_device_file((directory() / "devices/lhifam.toml").string(), {});
  HybridLoopOptions options;
  options.controller.kind = ControllerOptions::Kind::wall;
  options.controller.stiffness = 5000.0;
  options.initial_position = {1e-3, -2e-3};
  options.initial_velocity = {0.0, 0.1};
  options.user_force = {UserForce::Kind::sine, 5.0, 2.0 * std::numbers::pi * 3.0, 0.0205, {}, 0.0};
  HybridLoop loop(device, options);
  for (const std::vector<double>& row : rows) {
    ASSERT_EQ(row.size(), 8U);
    EXPECT_EQ(row[0], loop.time());
    EXPECT_EQ(row[3], loop.user_force());
    EXPECT_EQ(row[4], loop.position(0));
    EXPECT_EQ(row[7], loop.velocity(1));
    loop.step();
    EXPECT_EQ(row[1], loop.measured());
    EXPECT_EQ(row[2], loop.command());
  }
}

TEST_F(Simulate, TheCsvOfADoubtfulDeviceSaysSoInEveryRow) {
  write("doubtful.toml", contents("devices/lhifam.toml") + "\n[uncertainty]\nwarning = \"a reason\"\n");
  ASSERT_EQ(run("zwidth simulate doubtful.toml --set wall.stiffness=5000 --duration 0.01 --csv a.csv && "
                "zwidth bode doubtful.toml --output b.csv")
                .status,
            0);
  for (const char* file : {"a.csv", "b.csv"}) {
    std::istringstream lines(contents(file));
    std::string line;
    std::getline(lines, line);
    EXPECT_THAT(line, EndsWith(",trust")) << file;
    int rows = 0;
    for (; std::getline(lines, line); ++rows) EXPECT_THAT(line, EndsWith(",doubtful")) << file;
    EXPECT_GE(rows, 10) << file;
  }
}

TEST_F(Simulate, EveryThinsTheCsv) {
  ASSERT_EQ(run("zwidth simulate " + lhifam + "--duration 1 --every 10 --csv a.csv").status, 0);
  EXPECT_EQ(rows_of(contents("a.csv")).size(), 100U);
}

TEST_F(Simulate, PointsAreTheRowsOfTheCsv) {
  const auto document = json_of(lhifam + "--duration 1 --every 10 --csv a.csv --points");
  const auto rows = rows_of(contents("a.csv"));
  const auto& points = document["points"];
  ASSERT_EQ(points["time_s"].size(), rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    EXPECT_EQ(points["time_s"][i], rows[i][0]);
    EXPECT_EQ(points["command"][i], rows[i][2]);
    EXPECT_EQ(points["bodies"][1]["velocity"][i], rows[i][7]);
  }
}

TEST_F(Simulate, ARecordedForceIsReadInItsOwnTime) {
  std::string record = "time,force\n";
  for (int k = 0; k <= 100; ++k) record += std::to_string(0.002 * k) + "," + std::to_string(0.05 * k) + "\n";
  write("push.csv", record);
  ASSERT_EQ(
      run("zwidth simulate " + lhifam + "--user-force push.csv --user-force-scale 2 --duration 0.5 --csv a.csv").status,
      0);
  const auto rows = rows_of(contents("a.csv"));
  EXPECT_NEAR(rows[101][3], 2.0 * 0.05 * 50.5, 1e-9);  // between two samples
  EXPECT_EQ(rows[300][3], 0.0);                        // after the last
  EXPECT_GT(rows[200][4], 0.0);
}

TEST_F(Simulate, AnExcitationActsAsItWasWritten) {
  const std::string rotary = "devices/quanser_torsion.toml ";
  for (const std::string& device : {lhifam, rotary}) {
    const std::string signal = "--kind relay --amplitude 0.5 --lowest-hz 5 --duration 0.5 --fade-in 0 ";
    ASSERT_EQ(run("zwidth excite " + signal + "--device " + device + "--beyond-limits -o push.csv").status, 0);
    const Outcome outcome = run("zwidth simulate " + device + "--user-force push.csv --duration 0.1 --csv a.csv");
    ASSERT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(rows_of(contents("a.csv"))[20][3], 0.5);
  }
}

TEST_F(Simulate, SaysInItsFirstLinesWhatItsLimitIsWorth) {
  const std::string doubtful = lhifam + "--set uncertainty.warning=guessed ";
  const auto begins = [](const std::string& text, int lines) {
    std::size_t end = 0;
    for (int i = 0; i < lines; ++i) end = text.find('\n', end) + 1;
    return text.substr(0, end);
  };
  EXPECT_THAT(begins(run("zwidth simulate " + doubtful + "--start 1e-3").output, 2), HasSubstr("DOUBTFUL: guessed"));
  EXPECT_THAT(begins(run("zwidth relay " + doubtful + "--amplitude 5").output, 3), HasSubstr("DOUBTFUL: guessed"));
}

TEST_F(Simulate, FaultsAreRepeatedByTheirSeed) {
  const std::string faults = lhifam + "--lost-samples 0.2 --jitter 5e-4 --overrun 0.1,7e-4 --duration 1 ";
  const auto one = json_of(faults);
  EXPECT_EQ(one, json_of(faults));
  EXPECT_NE(one.at("final_position"), json_of(faults + "--seed 2").at("final_position"));
  EXPECT_EQ(one.at("faults").at("overrun_delay_s"), 7e-4);
}

TEST_F(Simulate, DrawsByExtension) {
  ASSERT_EQ(run("zwidth simulate " + lhifam + "--figure a.svg && zwidth simulate " + lhifam + "--figure a.PNG").status,
            0);
  EXPECT_THAT(contents("a.svg"), HasSubstr("motor (sensed)"));
  EXPECT_THAT(contents("a.svg"), HasSubstr("inside the wall"));
  EXPECT_THAT(contents("a.PNG"), StartsWith("\x89PNG"));
}

TEST_F(Simulate, ATransferFunctionStartsBesideItsWall) {
  write("tf.toml",
        "[transfer_function]\nnumerator = [1]\ndenominator = [5.4, 3.5, 0]\n[loop]\nsampling_period = 1e-3\n"
        "[wall]\nstiffness = 5000\n");
  const auto document = json_of("tf.toml");
  EXPECT_EQ(document.at("verdict"), "settles");
  EXPECT_EQ(document.at("wall").at("position"), -1e-3);
  EXPECT_THAT(document.at("start"), IsEmpty());
  expect_refused("tf.toml --start 1e-3", "a transfer function has no bodies");
  expect_refused("tf.toml --user-force step:1", "no body that a user could hold");
  expect_refused("tf.toml --wall-position 0", "where nothing moves the device");
}

TEST_F(Simulate, AWallBehindTheStartIsSaid) {
  const Outcome outcome = run("zwidth simulate " + lhifam + "--contact unilateral --start 2e-3 --duration 1");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("starts 2 mm inside the wall"));
  const Outcome never = run("zwidth simulate " + lhifam + "--contact unilateral --start=-2e-3 --duration 1");
  EXPECT_THAT(never.output, HasSubstr("never touches the wall"));
}

TEST_F(Simulate, Refusals) {
  expect_refused("devices/lhifam.toml", "nothing moves the device; add a wall");
  expect_refused("devices/lhifam.toml --set wall.stiffness=0", "nothing moves the device; add a wall");
  expect_refused(lhifam + "--start 1e300", "at most 1e30");
  expect_refused(lhifam + "--contact unilateral", "nothing presses the device against the wall");
  expect_refused(lhifam + "--contact both", "--contact");
  expect_refused(lhifam + "--start 0", "--start: every body starts at rest at 0");
  expect_refused(lhifam + "--start arm=1", "no body 'arm'; the device has motor, handle");
  expect_refused(lhifam + "--start motor=far", "--start: 'motor=far'");
  expect_refused(lhifam + "--start motor=nan", "--start: 'motor=nan'");
  expect_refused(lhifam + "--start-velocity ''", "--start-velocity: is empty");
  expect_refused(lhifam + "--duration 0", "--duration: is 0 s");
  expect_refused(lhifam + "--duration 1e6", "1 to 20000000 sampling periods");
  expect_refused(lhifam + "--duration nan", "--duration: is nan s");
  expect_refused(lhifam + "--set loop.delay=2 --duration 1", "no force would arrive");
  expect_refused(lhifam + "--user-force step:5@3 --duration 1", "begins at 3 s only");
  expect_refused(lhifam + "--user-force step:5,3", "step:N@S");
  expect_refused(lhifam + "--user-force sine:5", "sine:N,HZ@S");
  expect_refused(lhifam + "--user-force sine:5,0", "sine:N,HZ@S");
  expect_refused(lhifam + "--user-force sine:0,3", "has no force");
  expect_refused(lhifam + "--user-force ramp:1@-1", "ramp:N_PER_S@S");
  expect_refused(lhifam + "--user-force missing.csv", "--user-force: missing.csv");
  expect_refused(lhifam + "--lost-samples 1.5", "--lost-samples: is 1.5");
  expect_refused(lhifam + "--jitter 1e-3", "below the sampling period");
  expect_refused(lhifam + "--overrun 0.5", "--overrun");
  expect_refused(lhifam + "--overrun 0.5,-1", "--overrun: is -1");
  expect_refused(lhifam + "--overrun 0.5,1e9", "at most 10 s");
  expect_refused(lhifam + "--wall-position inf", "--wall-position: is inf");
  expect_refused(lhifam + "--divergence 0", "--divergence: is 0");
  expect_refused(lhifam + "--every 2", "--every: is for --csv, --figure and --points");
  expect_refused(lhifam + "--figure a.jpg", "unknown extension; .svg, .png or .pdf");
  expect_refused(lhifam + "--csv devices/lhifam.toml", "would overwrite the device file");
  write("pushes.csv", "time,force\n0,1\n1e-3,1\n2e-3,1\n");
  expect_refused(lhifam + "--user-force pushes.csv --csv ./pushes.csv", "would overwrite the recording");
  write("pushes.svg", "time,force\n0,1\n1e-3,1\n2e-3,1\n");
  expect_refused(lhifam + "--user-force pushes.svg --figure pushes.svg", "would overwrite the recording");
  EXPECT_THAT(contents("pushes.csv"), StartsWith("time,force\n0,1\n"));
  expect_refused(lhifam + "--duration 10000 --csv a.csv", "--every: is 1: 10000000 points; 2 or more");
  expect_refused("devices/lhifam.toml devices/lhifam.toml", "");
  EXPECT_FALSE(std::filesystem::exists(directory() / "a.csv"));
}

TEST_F(Simulate, ABadValueIsNamedBeforeWhatIsMissing) {
  for (const std::string duration : {"nan", "-1", "1e9"}) {
    expect_refused("devices/lhifam.toml --duration " + duration, "--duration: is " + duration.substr(0, 1));
  }
  expect_refused("devices/lhifam.toml --divergence 0", "--divergence: is 0");
  expect_refused("devices/lhifam.toml", "nothing moves the device");
}

TEST_F(Simulate, AnOutputThatCannotBeWrittenIsAFailure) {
  const Outcome outcome = run("zwidth simulate " + lhifam + "--csv none/a.csv");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("none/a.csv: cannot write"));
}

}  // namespace
}  // namespace zwidth::cli
