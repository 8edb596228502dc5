#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class Frf : public Workspace {
 protected:
  [[nodiscard]] json document(const std::string& command) const {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, 0) << command << "\n" << outcome.errors;
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1) << command;
    return json::parse(outcome.output, nullptr, false);
  }
};

bool has_finding(const json& document, const char* code) {
  const json& findings = document["findings"];
  return std::any_of(findings.begin(), findings.end(), [&](const json& each) { return each["code"] == code; });
}

const std::string example = "zwidth frf recordings/locked_chirp.csv --force force --position position ";
// Of the loop that made the example, by zwidth analyze on its device.
constexpr double example_stiffness = 31139.4;
constexpr double example_hz = 95.840;

TEST_F(Frf, TheExampleHoldsItsKnownCriticalStiffness) {
  const json found = document(example + "--json");
  EXPECT_EQ(found["schema"], "zwidth.frf/1");
  EXPECT_EQ(found["status"], "found");
  EXPECT_EQ(found["units"]["stiffness"], "N/m");
  EXPECT_NEAR(found["critical_stiffness"], example_stiffness, 0.01 * example_stiffness);
  EXPECT_NEAR(found["critical_frequency_hz"], example_hz, 0.3);
  EXPECT_LE(found["critical_stiffness_interval"][0], example_stiffness);
  EXPECT_GE(found["critical_stiffness_interval"][1], example_stiffness);
  ASSERT_EQ(found["crossovers"].size(), 1U);
  EXPECT_TRUE(found["crossovers"][0]["limited_by"].is_null());
  EXPECT_FALSE(found.contains("magnitude"));
}

TEST_F(Frf, PointsAddTheLines) {
  const json found = document(example + "--json --points");
  for (const char* key : {"frequency_hz", "magnitude", "magnitude_lower", "magnitude_upper", "phase_rad",
                          "phase_lower_rad", "phase_upper_rad", "coherence"}) {
    EXPECT_EQ(found[key].size(), found["lines"]) << key;
  }
  // 79.5 kN/m at low frequency, and the phase of a spring.
  EXPECT_NEAR(found["magnitude"][10].get<double>() * 79.5e3, 1.0, 0.1);
  EXPECT_NEAR(found["phase_rad"][10], 0.0, 0.1);
}

// A table does not say how far its lines share their noise, so that the curve through the crossing is of other lines: the limit
// is that of the recording within a fraction of its interval, not to the last digit.
TEST_F(Frf, TheTableItWritesIsReadBack) {
  const json measured = document(example + "--json --csv frf.csv");
  const json read = document("zwidth frf frf.csv --table --magnitude magnitude --phase phase_deg --rate 1000 --json");
  const double tenth = 0.1 * (measured["critical_stiffness_interval"][1].get<double>() -
                              measured["critical_stiffness_interval"][0].get<double>());
  EXPECT_NEAR(read["critical_stiffness"], measured["critical_stiffness"], tenth);
  const json complex =
      document("zwidth frf frf.csv --table --real real --imaginary imaginary --rate 1000 --lowest-hz 50 --json");
  EXPECT_NEAR(complex["critical_stiffness"], measured["critical_stiffness"], tenth);
}

TEST_F(Frf, AContinuousTableHasNoCriticalStiffness) {
  ASSERT_EQ(run(example + "--csv frf.csv").status, 0);
  const Outcome outcome = run("zwidth frf frf.csv --table --magnitude magnitude --phase phase_deg --json");
  const json read = json::parse(outcome.output);
  EXPECT_TRUE(read["status"].is_null());
  EXPECT_TRUE(read["critical_stiffness"].is_null());
  EXPECT_TRUE(has_finding(read, "response_without_rate"));
  EXPECT_THAT(outcome.errors, IsEmpty());
}

TEST_F(Frf, ScalesAndUnitsGoIntoTheStiffness) {
  const json found = document(example + "--position-scale 1000 --position-unit mm --force-unit 'N m' --json");
  EXPECT_EQ(found["units"]["stiffness"], "N m/mm");
  EXPECT_NEAR(found["critical_stiffness"].get<double>() * 1000.0, example_stiffness, 0.01 * example_stiffness);
}

// A torque and an angle were labelled N and m, although the columns were read by the units in their names.
TEST_F(Frf, TheUnitsAreThoseOfTheColumns) {
  const std::string linear = contents("recordings/locked_chirp.csv");
  const std::string samples = linear.substr(linear.find('\n'));
  write("rotary.csv", "time,torque [mNm],angle_rad" + samples);
  const std::string rotary = "rotary.csv --force 'torque [mNm]' --position angle_rad --json";
  const json found = document("zwidth frf " + rotary);
  EXPECT_EQ(found["units"]["force"], "N m");
  EXPECT_EQ(found["units"]["position"], "rad");
  EXPECT_EQ(found["units"]["stiffness"], "N m/rad");
  EXPECT_NEAR(found["critical_stiffness"].get<double>(), 1e-3 * example_stiffness, 1e-5 * example_stiffness);
  expect_refusal(
      "zwidth frf " + rotary + " --position-unit turn",
      "--position-unit: is turn, but the column is read in rad by its name; leave it out, or give the scale too");
  expect_refusal(example + "--force-unit $'N\\nm'", "--force-unit: is no unit; at most 24 characters, on one line");
  EXPECT_EQ(document("zwidth frf " + rotary + " --force-scale 1e-3")["units"]["stiffness"], "N m/rad");
  const json named =
      json::parse(run("zwidth identify " + rotary + " --method frequency-response --structure two-body").output);
  EXPECT_EQ(named["parameters"][0]["unit"], "kg m²");
  for (const std::string structure : {"two-body --motion linear", "devices/lhifam.toml"}) {
    const json other =
        json::parse(run("zwidth identify " + rotary + " --method frequency-response --structure " + structure).output);
    EXPECT_NE(other["trust"]["verdict"], "sound") << structure;
    EXPECT_TRUE(has_finding(other, "channel_of_other_motion")) << structure;
  }
  write("mixed.csv", "time,torque_Nm,x_mm" + samples);
  const json mixed =
      json::parse(run("zwidth identify mixed.csv --force torque_Nm --position x_mm --method frequency-response "
                      "--structure two-body --json")
                      .output);
  EXPECT_TRUE(has_finding(mixed, "channels_of_two_motions"));
  EXPECT_NE(document("zwidth frf mixed.csv --force torque_Nm --position x_mm --json")["trust"]["verdict"], "sound");
}

TEST_F(Frf, ABandWithoutTheCrossoverIsSaidNotGuessed) {
  const Outcome outcome = run(example + "--highest-hz 70 --json");
  EXPECT_EQ(outcome.status, 0);
  const json found = json::parse(outcome.output);
  EXPECT_EQ(found["status"], "not_in_band");
  EXPECT_TRUE(found["critical_stiffness"].is_null());
  EXPECT_TRUE(found["critical_stiffness_interval"].is_null());
  EXPECT_TRUE(has_finding(found, "no_crossover_in_band"));
  EXPECT_THAT(outcome.errors, IsEmpty());
}

TEST_F(Frf, TextAndFigureSayTheSame) {
  const Outcome outcome = run(example + "--output frf.svg");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("critical stiffness  31."));
  EXPECT_THAT(outcome.output, HasSubstr("<- critical"));
  const std::string figure = contents("frf.svg");
  EXPECT_THAT(figure, HasSubstr("Coherence"));
  EXPECT_THAT(figure, HasSubstr(": critical"));
  EXPECT_THAT(figure, HasSubstr("</svg>"));
}

TEST_F(Frf, ListsTheColumns) {
  const Outcome outcome = run("zwidth frf recordings/locked_chirp.csv --list");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.output, HasSubstr("position"));
  EXPECT_THAT(outcome.output, HasSubstr("10000"));
  const json listed = document("zwidth frf recordings/locked_chirp.csv --list --json");
  EXPECT_EQ(listed["schema"], "zwidth.recording/1");
  EXPECT_EQ(listed["columns"][2], json::parse(R"({"name": "position", "samples": 10000, "detail": "numbers"})"));
  // As stated: the header is a line to skip, and columns are numbers.
  const json bare = document("zwidth frf recordings/locked_chirp.csv --list --json --no-header");
  EXPECT_EQ(bare["columns"][0]["name"], "1");
}

/// The example as TwinCAT Scope exports it: a time column in ms for each channel, decimal commas.
std::string scope_export(const std::string& table) {
  std::istringstream lines(table);
  std::string text =
      "Name\tScope Project\t\nFile\trun.csv\t\nStarttime of export\t132959733843760000\tMontag, 2. Mai "
      "2022\t15:56:24.376\n\n\n"
      "Name\tforce\tName\tposition\nSampleTime[ms]\t1\tSampleTime[ms]\t1\nOffset\t0\tOffset\t0\nScaleFactor\t1\t"
      "ScaleFactor\t1\nUnit\tN\tUnit\tm\n\n";
  for (std::string line; std::getline(lines, line);) {
    double time = 0.0;
    double force = 0.0;
    double position = 0.0;
    if (std::sscanf(line.c_str(), "%lf,%lf,%lf", &time, &force, &position) != 3) continue;
    std::string row = fmt::format("{0:.9g}\t{1:.17g}\t{0:.9g}\t{2:.17g}\n", 1e3 * time, force, position);
    std::replace(row.begin(), row.end(), '.', ',');
    text += row;
  }
  return text + "EOF\n";
}

TEST_F(Frf, AnExportGivesWhatItsTableGives) {
  const std::string table = contents("recordings/locked_chirp.csv");
  write("scope.csv", scope_export(table));
  write("unknown.csv", "Rig;7\nChannel;force;position\nFactor;1;1\n" + table);
  const json expected = document(example + "--json");
  const json found = document("zwidth frf scope.csv --force force --position position --json");
  EXPECT_NEAR(found["critical_stiffness"], expected["critical_stiffness"].get<double>(), 1e-6 * example_stiffness);
  const json skipped = document("zwidth frf unknown.csv --force force --position position --skip-rows 3 --json");
  EXPECT_EQ(skipped["critical_stiffness"], expected["critical_stiffness"]);
  write("labelled.csv", "Signal;F;x\nFactor;2;3\n0;1;2\n1;2;3\n2;3;4\n3;4;5\n");
  expect_refusal("zwidth frf labelled.csv --force F --position x --rate 1000", "--skip-rows 2");
}

TEST_F(Frf, ReadsStandardInput) {
  const json found = document("zwidth frf - --force force --position position --json < recordings/locked_chirp.csv");
  EXPECT_NEAR(found["critical_stiffness"], example_stiffness, 0.01 * example_stiffness);
}

/// Two recordings with friction: a sine of 2 Hz of each force on a mass, its motion smaller than linear by `lost`.
std::string sine_recording(double amplitude, double lost, double hertz) {
  std::string text = "time,force,position\n";
  for (int k = 0; k < 4000; ++k) {
    const double phase = 2.0 * 3.141592653589793 * hertz * 0.001 * k;
    const double noise = 1e-5 * std::sin(1e3 * k * k);
    text += std::to_string(0.001 * k) + "," + std::to_string(amplitude * std::sin(phase)) + "," +
            std::to_string(-(amplitude - lost) * 0.01 * std::sin(phase) + noise) + "\n";
  }
  return text;
}

TEST_F(Frf, PoolsRecordingsAndSaysThatTheyDependOnTheForce) {
  write("weak.csv", sine_recording(1.0, 0.2, 2.0));
  write("strong.csv", sine_recording(5.0, 0.2, 2.0));
  write("faster.csv", sine_recording(5.0, 0.2, 3.7));
  const json found =
      document("zwidth frf weak.csv strong.csv faster.csv --force force --position position --json --points");
  EXPECT_EQ(found["recording"], "weak.csv and 2 more");
  ASSERT_EQ(found["lines"], 2);  // 2 Hz pooled, and 3.7 Hz
  EXPECT_NEAR(found["frequency_hz"][1], 3.7, 1e-3);
  EXPECT_NEAR(found["amplitude_dependence"]["force_ratio"], 5.0, 1e-3);
  EXPECT_NEAR(found["amplitude_dependence"]["difference"], 0.16 / 0.96, 5e-3);
  EXPECT_TRUE(found["amplitude_dependence"]["grows_with_force"]);
  EXPECT_TRUE(document(example + "--json")["amplitude_dependence"].is_null());
}

// The doubt was lost: `identify --table` called such a table sound.
TEST_F(Frf, ATableItWritesKeepsItsDoubt) {
  const std::string table = " --table --real real --imaginary imaginary --rate 1000 --json";
  ASSERT_EQ(run(example + "--highest-hz 70 --csv refused.csv").status, 0);
  const json written = document(example + "--highest-hz 70 --json");
  ASSERT_EQ(written["trust"]["verdict"], "refused");
  const json refused = document("zwidth frf refused.csv" + table);
  EXPECT_EQ(refused["trust"]["verdict"], "refused");
  EXPECT_EQ(refused["trust"]["reasons"][0], written["trust"]["reasons"][0]);
  EXPECT_TRUE(refused["critical_stiffness"].is_null());
  const json fitted = document("zwidth identify refused.csv --structure rigid" + table);
  EXPECT_NE(fitted["trust"]["verdict"], "sound");

  const std::string text = contents("refused.csv");
  const std::string header = text.substr(0, text.find('\n'));
  EXPECT_TRUE(header.ends_with(",trust,trust_reasons")) << header;
}

TEST_F(Frf, TakesTheLinesThatAreGiven) {
  write("sine.csv", sine_recording(5.0, 0.0, 2.0));
  const std::string command = "zwidth frf sine.csv --force force --position position --json --points --lines ";
  EXPECT_NEAR(document(command + "2")["magnitude"][0], 0.01, 1e-4);
  // One sine holds one line, of all that are asked for.
  EXPECT_EQ(document(command + "'2 Hz,0.003 kHz'")["frequency_hz"].size(), 1U);
  EXPECT_NEAR(document(command + "'2 Hz:4 Hz:3'")["frequency_hz"][0], 2.0, 1e-12);
  expect_refusal(command + "2:3", "--lines: \"2:3\"; a frequency, or FIRST:LAST:COUNT");
  expect_refusal(command + "'2 kg'", "--lines: \"kg\" is no unit of a frequency");
  expect_refusal(command + "0", "--lines: has 0 Hz; must be finite and above 0");
  expect_refusal(command + "600", "--lines: sine.csv: line at 600 Hz; below half the sampling rate, 500 Hz");
  expect_refusal(command + "2 --period 500", "lines are fitted in the whole record");
}

TEST_F(Frf, RefusesRecordingsThatDoNotBelongTogether) {
  write("slow.csv", "force,position\n1,2\n3,4\n");
  write("empty.csv", "time,force,position\n");
  expect_refusal("zwidth frf recordings/locked_chirp.csv recordings/locked_chirp.csv --force force --position position",
                 "locked_chirp.csv: holds the same samples as recordings/locked_chirp.csv; give each recording once");
  // Other rates are pooled, each on its own times.
  EXPECT_EQ(
      run("zwidth frf recordings/locked_chirp.csv recordings/free_motion.csv --force force --position position").status,
      0);
  expect_refusal("zwidth frf recordings/locked_chirp.csv empty.csv --force force --position position", "empty.csv");
  expect_refusal("zwidth frf a.csv b.csv --table", "more than one file: is for a recording");
}

TEST_F(Frf, AFigureHasTwoNames) {
  ASSERT_EQ(run(example + "--output one.svg").status, 0);
  ASSERT_EQ(run(example + "--figure other.svg").status, 0);
  EXPECT_EQ(contents("one.svg"), contents("other.svg"));
}

TEST_F(Frf, ColumnsNamedForceAndPositionNeedNoOption) {
  const auto named = run("zwidth frf recordings/locked_chirp.csv --force force --position position --json");
  EXPECT_EQ(named.status, 0);
  EXPECT_EQ(run("zwidth frf recordings/locked_chirp.csv --json").output, named.output);
}

TEST_F(Frf, SoDoColumnsCalledSoWithAUnit) {
  const json plain = document(example + "--json");
  const auto renamed = [&](const std::string& names) {
    return "sed '1s/.*/" + names + "/' recordings/locked_chirp.csv > renamed.csv && zwidth frf renamed.csv";
  };
  ASSERT_THAT(run("head -n 1 recordings/locked_chirp.csv").output, "time,force,position\n");
  const json rotary = document(renamed("time,torque_N_m,angle [rad]") + " --json");
  EXPECT_EQ(rotary["critical_stiffness"], plain["critical_stiffness"]);
  EXPECT_EQ(rotary["units"]["stiffness"], "N m/rad");
  // Without a unit the names alone say that it turns.
  EXPECT_EQ(document(renamed("time,torque,angle") + " --json")["units"]["stiffness"], "N m/rad");
  // The reader scales by what such a name ends with.
  const json small = document(renamed("time,torque_mNm,angle_deg") + " --json");
  const double milli_per_degree = 1e-3 * 180.0 / std::numbers::pi;
  const double stiffness = plain["critical_stiffness"].get<double>();
  EXPECT_NEAR(small["critical_stiffness"].get<double>(), milli_per_degree * stiffness, 1e-6 * stiffness);
  expect_refusal(renamed("time,force_error,position"), "--force: missing");
  // What the reader would not scale by: feet, or what comes in.
  for (const char* name : {"position_ft", "position_in", "position_km"}) {
    expect_refusal(renamed(std::string("time,force,") + name), "--position: missing");
  }
}

TEST_F(Frf, RefusesInOneLineThatNamesThePlace) {
  write("other_names.csv", "time,f,x\n0,1,2\n");
  expect_refusal("zwidth frf other_names.csv", "--force: missing; name the column of the commanded force");
  expect_refusal("zwidth frf other_names.csv --force f", "has: time, f, x");
  expect_refusal("zwidth frf missing.csv --force 1 --position 2", "missing.csv");
  expect_refusal("zwidth frf recordings/locked_chirp.csv --force force --position angle",
                 "--position: recordings/locked_chirp.csv: angle: no such column; the file has 3 columns: time, force");
  expect_refusal(example + "--time tyme", "--time: recordings/locked_chirp.csv: tyme: no such column");
  expect_refusal(example + "--velocity time", "give one");
  for (const std::string motion : {"--position force", "--velocity 2", "--acceleration Force"}) {
    expect_refusal("zwidth frf recordings/locked_chirp.csv --force force " + motion,
                   "locked_chirp.csv: column 'force' is named as the force and as the motion");
  }
  expect_refusal(example + "--period 6000", "--period: recordings/locked_chirp.csv: period of 6000 samples");
  expect_refusal(example + "--period 1000 --skip-periods 9", "--skip-periods: recordings/locked_chirp.csv: 9 of 10");
  expect_refusal(example + "--aperiodic --skip-periods 2", "--skip-periods: is 2 for an aperiodic force");
  expect_refusal(example + "--segment 20000", "--segment: recordings/locked_chirp.csv: segments of 20000 samples");
  expect_refusal(example + "--overlap 1", "from 0 to below 1");
  expect_refusal(example + "--lowest-hz nan", "above 0");
  expect_refusal(example + "--lowest-hz 50 --highest-hz 40", "--highest-hz: is 40 Hz; must be above the lowest, 50 Hz");
  expect_refusal(example + "--lowest-hz 400", "--lowest-hz: recordings/locked_chirp.csv: no line is left in the band");
  expect_refusal(example + "--rate 0", "--rate");
  expect_refusal(example + "--rate 1e40", "--rate: is 1e+40 Hz; must be from 1e-30 to 1e+30");
  expect_refusal(example + "--position-scale 0", "--position-scale: is 0; must be finite and not 0");
  expect_refusal(example + "--delimiter x", "comma, semicolon, tab or space");
  expect_refusal(example + "--table", "--force: is for a recording");
  expect_refusal(example + "--output frf.txt", "unknown extension");
  expect_refusal(example + "--points", "add --json");
  expect_refusal(example + "--csv recordings/locked_chirp.csv", "would overwrite the recording");
  expect_refusal("zwidth frf recordings/locked_chirp.csv --force time --position position --frequency 1", "--table");
}

TEST_F(Frf, AConstantForceIsRefused) {
  std::string rows = "time,force,position\n";
  for (int i = 0; i < 100; ++i) rows += std::to_string(i) + ",1," + std::to_string(i % 7) + "\n";
  write("constant.csv", rows);
  expect_refusal("zwidth frf constant.csv --force force --position position", "the force is constant");
}

// "No line is left in the band asked for; widen it", though none was asked for.
TEST_F(Frf, ARecordWithoutLinesSaysWhy) {
  std::string rows = "time,force,position\n";
  double velocity = 0.0;
  double position = 0.0;
  for (int k = 0; k < 50; ++k) {  // 0.3 kg
    const double t = 1e-3 * k;
    const double force = std::sin(300.0 * t) + std::cos(777.0 * t);
    rows += fmt::format("{:.3f},{:.9f},{:.12g}\n", t, force, position);
    velocity += 1e-3 * (force - velocity) / 0.3;
    position += 1e-3 * velocity;
  }
  write("short.csv", rows);
  expect_refusal("zwidth frf short.csv --force force --position position", "50 samples (0.05 s)");
  expect_refusal("zwidth frf short.csv --force force --position position", "record for longer");
  rows = "time,force,position\n";
  for (int k = 0; k < 8000; ++k) {
    const double t = 1e-3 * k;
    double force = 0.0;
    for (int line = 1; line <= 40; ++line) force += std::sin(3.141592653589793 * line * t + 0.3 * line * line);
    rows += fmt::format("{},{},{}\n", t, force, 1e-3 * std::sin(3.0 * t));
  }
  write("periodic.csv", rows);
  expect_refusal("zwidth frf periodic.csv --force force --position position --period 1900",
                 "it repeats every 2000 samples");
}

class MotorBench : public Frf {
 protected:
  void SetUp() override {
    file_ = fs::path(ZWIDTH_SHARED_DIR) / "data" / "two_mass_bench" / "MultisineTypeA.mat";
    if (!fs::exists(file_)) GTEST_SKIP() << "no recordings beside the project";
  }
  /// Critical stiffness and crossovers as read off the raw data by others: 301.7 A/rad at 81.22 Hz, 28.56 and 46.9 Hz.
  json expect_known(const std::string& options) const {
    json found = document(fmt_command(options));
    EXPECT_EQ(found["status"], "found") << options;
    EXPECT_LE(found["critical_stiffness_interval"][0], 301.7) << options;
    EXPECT_GE(found["critical_stiffness_interval"][1], 301.7) << options;
    EXPECT_NEAR(found["critical_frequency_hz"], 81.2, 1.0) << options;
    EXPECT_EQ(found["crossovers"].size(), 3U) << options;
    using Known = std::pair<std::size_t, double>;
    for (const auto& [index, known] : {Known{0, 28.56}, Known{1, 46.9}}) {
      EXPECT_LE(found["crossovers"][index]["frequency_interval_hz"][0], known) << options;
      EXPECT_GE(found["crossovers"][index]["frequency_interval_hz"][1], known) << options;
    }
    return found;
  }
  void expect_known_closely(const std::string& options) const {
    const json found = expect_known(options);
    EXPECT_NEAR(found["critical_stiffness"], 301.7, 0.02 * 301.7) << options;
    EXPECT_NEAR(found["critical_frequency_hz"], 81.2, 0.5) << options;
  }
  [[nodiscard]] std::string fmt_command(const std::string& options) const {
    return "zwidth frf '" + file_.string() + "' --force iq_refx --position theta_mx --rate 2500 --json " + options;
  }

 private:
  fs::path file_;
};

TEST_F(MotorBench, WithTheStatedPeriod) { expect_known_closely("--period 2500 --skip-periods 3"); }

TEST_F(MotorBench, WithItsPeriodDetected) {
  expect_known_closely("");
  EXPECT_EQ(document(fmt_command(""))["lines"], 240);  // 11, 12, ..., 250 Hz
}

// The lines near 81 Hz scatter by 4 % about any smooth curve, as nonlinear distortion does.
TEST_F(MotorBench, WithoutUseOfThePeriod) { expect_known("--aperiodic"); }

}  // namespace
}  // namespace zwidth::cli
