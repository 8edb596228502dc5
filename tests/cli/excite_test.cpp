#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class Excite : public Workspace {
 protected:
  void expect_refusal(const std::string& options, int status, const std::string& message) const {
    const Outcome outcome = run("zwidth excite " + options);
    EXPECT_EQ(outcome.status, status) << options;
    EXPECT_THAT(outcome.errors, AllOf(StartsWith("zwidth: "), HasSubstr(message))) << options;
    EXPECT_EQ(outcome.output, "") << options;
  }
};

struct Row {
  double time = 0.0;
  double force = 0.0;
};

std::vector<Row> rows_of(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::vector<Row> rows;
  while (std::getline(lines, line)) {
    rows.push_back({std::stod(line), std::stod(line.substr(line.find(',') + 1))});
  }
  return rows;
}

TEST_F(Excite, WritesTimeAndForce) {
  const Outcome outcome = run("zwidth excite --amplitude 5 --output chirp.csv");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.errors, "");
  EXPECT_THAT(outcome.output, HasSubstr("peak 5 N, rms 3.536 N, crest factor 1.414"));
  EXPECT_THAT(contents("chirp.csv"), StartsWith("time_s,force_N\n0,0\n0.001,"));
  const std::vector<Row> rows = rows_of(contents("chirp.csv"));
  ASSERT_EQ(rows.size(), 20000U);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    const double t = 1e-3 * static_cast<double>(k);
    ASSERT_DOUBLE_EQ(rows[k].time, t);
    const double turns = 10.0 * t + 190.0 * t * t / 40.0;
    ASSERT_NEAR(rows[k].force, 5.0 * std::sin(2.0 * std::numbers::pi * turns), 1e-7);
  }
  const Outcome piped = run("zwidth excite --amplitude 5");
  EXPECT_EQ(piped.output, contents("chirp.csv"));
  EXPECT_EQ(piped.errors, outcome.output);  // the summary makes way
  EXPECT_EQ(run("zwidth excite --amplitude 5 --output -").output, contents("chirp.csv"));
  EXPECT_EQ(run("zwidth excite --amplitude 5 --csv -").output, contents("chirp.csv"));
}

TEST_F(Excite, SummaryAsJson) {
  const Outcome outcome = run(
      "zwidth excite --kind multisine --amplitude 3 --lowest-hz 1 --highest-hz 100 --duration 20 --periods 10 --json "
      "--device devices/lhifam.toml --output m.csv");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.errors, "");
  const auto summary = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(summary.at("schema"), "zwidth.excitation/1");
  EXPECT_EQ(summary.at("kind"), "multisine");
  EXPECT_EQ(summary.at("samples"), 20000);
  EXPECT_EQ(summary.at("period_samples"), 2000);
  EXPECT_EQ(summary.at("highest_hz"), 100.0);
  EXPECT_NEAR(summary.at("peak_force").get<double>(), 3.0, 1e-9);
  EXPECT_LT(summary.at("crest_factor").get<double>(), 1.9);
  EXPECT_TRUE(summary.at("check").at("within_limits"));
  EXPECT_GT(summary.at("check").at("largest_motion").get<double>(), 0.0);
  EXPECT_EQ(rows_of(contents("m.csv")).size(), 20000U);
  const auto relay = nlohmann::json::parse(run("zwidth excite --kind relay --amplitude 3 --lowest-hz 5 --json").output);
  EXPECT_TRUE(relay.at("highest_hz").is_null());
  EXPECT_TRUE(relay.at("check").is_null());
  EXPECT_EQ(relay.at("period_samples"), 200);
  const auto unstable = nlohmann::json::parse(
      run("printf '[transfer_function]\\nnumerator=[1]\\ndenominator=[1,0,-1e6]\\n[loop]\\nsampling_period=1e-3\\n' > "
          "u.toml; zwidth excite --amplitude 3 --json --device u.toml")
          .output);
  EXPECT_TRUE(unstable.at("check").at("largest_motion").is_null());
}

TEST_F(Excite, TheDeviceGivesRateAndUnits) {
  const Outcome outcome = run("zwidth excite --amplitude 0.1 --device devices/quanser_torsion.toml --duration 1");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, StartsWith("time_s,torque_N_m\n"));
  EXPECT_THAT(outcome.errors, HasSubstr("rad from its start"));
  EXPECT_EQ(rows_of(run("zwidth excite --amplitude 1 --duration 1 --device devices/lhifam.toml --set "
                        "loop.sampling_period=0.5e-3")
                        .output)
                .size(),
            2000U);
}

TEST_F(Excite, AnExceededLimitFailsAndLeavesTheOldFile) {
  write("chirp.csv", "old");
  const std::string options =
      "--amplitude 30 --device devices/lhifam.toml --set actuator.force_limit=20 --stroke 0.01 --output chirp.csv";
  expect_refusal(options, 1, "the peak force, 30 N, is beyond the actuator's limit, 20 N");
  expect_refusal(options, 1, "beyond the stroke of 0.01 m");
  EXPECT_EQ(contents("chirp.csv"), "old");
  const Outcome forced = run("zwidth excite --beyond-limits " + options);
  EXPECT_EQ(forced.status, 0);
  EXPECT_THAT(forced.errors, HasSubstr("beyond the stroke"));
  EXPECT_THAT(contents("chirp.csv"), StartsWith("time_s,force_N\n"));
}

TEST_F(Excite, DrawsTheSignal) {
  ASSERT_EQ(run("zwidth excite --amplitude 5 --figure a.svg && zwidth excite --amplitude 5 --kind multisine --figure "
                "b.PNG && zwidth excite --amplitude 5 --kind relay --lowest-hz 3 --duration 1 --figure c.pdf")
                .status,
            0);
  EXPECT_THAT(contents("a.svg"), AllOf(HasSubstr("Linear chirp, 10 to 200 Hz"), HasSubstr("Power density")));
  EXPECT_THAT(contents("b.PNG"), StartsWith("\x89PNG"));
  EXPECT_THAT(contents("c.pdf"), StartsWith("%PDF"));
}

TEST_F(Excite, Refusals) {
  expect_refusal("", 2, "--amplitude is required");
  expect_refusal("--amplitude 0", 2, "--amplitude: is 0; must be a force > 0");
  expect_refusal("--amplitude 1e40", 2, "--amplitude: is 1e+40; must be from 1e-30 to 1e+30");
  expect_refusal("--amplitude 1 --rate 1e40", 2, "--rate: times the duration is 2e+41; 2 to 1e+08 samples");
  expect_refusal("--amplitude nan", 2, "--amplitude: is nan");
  expect_refusal("--amplitude 1 --highest-hz 600", 2, "--highest-hz: is 600 Hz; must be from 10 to 500");
  expect_refusal("--amplitude 1 --duration 1e9", 2, "2 to 1e+08 samples");
  expect_refusal("--amplitude 1 --fade-in 11", 2, "--fade-in: is 11");
  expect_refusal("--amplitude 1 --kind sweep", 2, "--kind");
  expect_refusal("--amplitude 1 --periods 3", 2, "--periods: is for a multisine; --kind is linear-chirp");
  expect_refusal("--amplitude 1 --seed 3", 2, "--seed: is for noise");
  expect_refusal("--amplitude 1 --kind relay --highest-hz 3", 2, "--highest-hz: is for a band");
  expect_refusal("--amplitude 1 --stroke 3", 2, "--stroke requires --device");
  expect_refusal("--amplitude 1 --stroke 0 --device devices/lhifam.toml", 2, "--stroke: is 0");
  expect_refusal("--amplitude 1 --device none.toml", 2, "none.toml");
  expect_refusal("--amplitude 1 --device devices/lhifam.toml --output devices/lhifam.toml", 2, "would overwrite");
  expect_refusal("--amplitude 1 --figure a.jpg", 2, "unknown extension");
  expect_refusal("--amplitude 1 --figure a.svg --output a.svg", 2, "same file");
  expect_refusal("--amplitude 1 --json --output -", 2, "standard output is taken");
  expect_refusal("--amplitude 1 --output none/a.csv", 1, "none/a.csv: cannot write");
}

TEST_F(Excite, AFullDiskLeavesNoFile) {
  const Outcome outcome = run("ulimit -f 16; zwidth excite --amplitude 1 --output a.csv");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("a.csv: cannot write: File too large"));
  EXPECT_FALSE(fs::exists(directory() / "a.csv"));
  EXPECT_EQ(run("ls -A | grep part").output, "");
}

}  // namespace
}  // namespace zwidth::cli
