#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class Relay : public Workspace {
 protected:
  void expect_refused(const std::string& arguments, const std::string& message) const {
    const Outcome outcome = run("zwidth relay " + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments << "\n" << outcome.errors;
    EXPECT_THAT(outcome.output, IsEmpty()) << arguments;
    EXPECT_THAT(outcome.errors, StartsWith("zwidth: " + message)) << arguments;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  }

  nlohmann::json json(const std::string& arguments) const {
    const Outcome outcome = run("zwidth relay --json " + arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output, nullptr, false);
  }
};

const std::string set_a = "devices/lhifam_reduced_pretension.toml --delay 6.25e-3 ";
const std::string friction = "--set body.handle.coulomb=0.4 ";

TEST_F(Relay, ARecordedTrialIsReadAsItWasSimulated) {
  const auto simulated = json(set_a + friction + "--amplitude 5 --start 0.03 --csv run.csv");
  for (std::size_t trial = 1; trial <= 4; ++trial) {
    const auto recorded = json("--recording run.csv --force force_" + std::to_string(trial) + " --position position_" +
                               std::to_string(trial));
    const auto& wanted = simulated["trials"][trial - 1]["result"];
    const auto& found = recorded["trials"][0]["result"];
    EXPECT_NEAR(found["frequency_hz"], wanted["frequency_hz"], 1e-9);
    EXPECT_NEAR(found["stiffness"], wanted["stiffness"], 1e-9 * wanted["stiffness"].get<double>());
    EXPECT_EQ(found["steady_samples"], wanted["steady_samples"]);
    EXPECT_NEAR(recorded["relay"]["amplitude"], 5.0, 1e-12);
    EXPECT_TRUE(recorded["predictions"].is_null());
  }
  const auto compared = json(set_a + friction + "--recording run.csv --force 2 --position 3");
  EXPECT_EQ(compared["predictions"], simulated["predictions"]);
}

TEST_F(Relay, TheDelayIsAddedToTheDevices) {
  const auto added = json(set_a + "--amplitude 5 --set loop.delay=1e-3 --duration 2");
  EXPECT_NEAR(added["delay_s"], 7.25e-3, 1e-15);
}

TEST_F(Relay, SeedsDecideTheTrials) {
  const std::string arguments = set_a + friction + "--amplitude 5 --start 0.03 --duration 3 ";
  EXPECT_EQ(json(arguments + "--seed 3"), json(arguments + "--seed 3"));
  EXPECT_NE(json(arguments + "--seed 3"), json(arguments + "--seed 4"));
}

// There is no trial to draw: it was a crash.
TEST_F(Relay, OfARefusedDeviceNothingIsDrawn) {
  write("refused.toml",
        contents("devices/lhifam.toml") + "\n[uncertainty]\nverdict = 'refused'\nwarning = 'nothing is known'\n");
  for (const std::string file : {"x.svg", "x.csv"}) {
    const std::string option = file == "x.csv" ? " --csv " : " --figure ";
    const Outcome outcome = run("zwidth relay refused.toml --amplitude 5" + option + file);
    EXPECT_EQ(outcome.status, 1) << outcome.errors;
    EXPECT_THAT(outcome.errors, HasSubstr(file + ": is not written: REFUSED"));
    EXPECT_FALSE(std::filesystem::exists(directory() / file));
  }
  EXPECT_EQ(run("zwidth relay refused.toml --amplitude 5").status, 0);
}

TEST_F(Relay, NoOscillationIsAVerdict) {
  const Outcome stuck = run("zwidth relay devices/lhifam_rigid.toml --amplitude 5 --set body.0.coulomb=6");
  EXPECT_EQ(stuck.status, 0) << stuck.errors;
  EXPECT_THAT(stuck.output, HasSubstr("trial 1: no oscillation: the force never changes"));
  write("still.csv", [] {
    std::string rows = "t,f,x\n";
    for (int k = 0; k < 1000; ++k) rows += std::to_string(1e-3 * k) + ",1.5,0.001\n";
    return rows;
  }());
  const auto still = json("--recording still.csv --force f --position x");
  EXPECT_EQ(still["trials"][0]["oscillates"], false);
  EXPECT_THAT(still["trials"][0]["reason"].get<std::string>(), HasSubstr("the force never changes"));
}

TEST_F(Relay, AShortRecordIsOneSegmentAndSaysSo) {
  const Outcome outcome = run("zwidth relay " + set_a + "--amplitude 5 --duration 5");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("less than a segment of 8192"));
}

TEST_F(Relay, AVeryLongDelayNeitherHangsNorFillsTheScreen) {
  const Outcome outcome =
      run("zwidth relay devices/lhifam.toml --amplitude 5 --delay 2 --trials 1 --set body.handle.coulomb=0.4");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_LT(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 100);
  EXPECT_THAT(outcome.output, HasSubstr("more"));
}

TEST_F(Relay, FiguresAreWrittenInEveryFormat) {
  for (const std::string file : {"relay.svg", "relay.png", "relay.PDF"}) {
    EXPECT_EQ(run("zwidth relay " + set_a + "--amplitude 5 --duration 3 --trials 1 --figure " + file).status, 0);
    EXPECT_GT(std::filesystem::file_size(directory() / file), 1000U) << file;
  }
}

TEST_F(Relay, RefusesWhatMakesNoSense) {
  expect_refused("", "FILE: missing");
  expect_refused(set_a, "--amplitude: missing");
  expect_refused(set_a + "--amplitude 0", "--amplitude: is 0");
  expect_refused(set_a + "--amplitude nan", "--amplitude: is nan");
  expect_refused(set_a + "--amplitude 5 --set actuator.force_limit=4", "--amplitude: is 5; at most");
  expect_refused(set_a + "--amplitude 5 --hysteresis -1", "--hysteresis: is -1");
  expect_refused("devices/lhifam.toml --amplitude 5 --delay -1", "--delay: is -1");
  expect_refused("devices/lhifam.toml --amplitude 5 --delay 100", "--delay: loop.delay");
  expect_refused("devices/lhifam.toml --amplitude 5 --delay 5 --duration 4", "--duration: ");
  expect_refused(set_a + "--amplitude 5 --duration 0", "--duration: is 0");
  expect_refused(set_a + "--amplitude 5 --duration inf", "--duration: is inf");
  expect_refused(set_a + "--amplitude 5 --duration 1e7", "--duration: ");
  expect_refused(set_a + "--amplitude 5 --duration 0.01", "--duration: ");
  expect_refused(set_a + "--amplitude 5 --start inf", "--start: is inf");
  expect_refused(set_a + "--amplitude 5 --variation 1", "--variation: is 1");
  expect_refused(set_a + "--amplitude 5 --trials 0", "relay: --trials");
  expect_refused(set_a + "--amplitude 5 --segment 10", "relay: --segment");
  expect_refused(set_a + "--amplitude 5 --steady 0", "--steady: is 0");
  expect_refused(set_a + "--amplitude 5 --figure x.gif", "--figure: x.gif: unknown extension");
  expect_refused("devices/lhifam.toml --amplitude 5 --csv devices/lhifam.toml", "--csv: devices/lhifam.toml: would");
  expect_refused(set_a + "--amplitude 5 --csv q.svg --figure q.svg",
                 "--figure: q.svg: is the same file as that of --csv");
  expect_refused(set_a + "--amplitude 5 --force f", "--force: is about a recording");
  expect_refused(set_a + "--amplitude 5 --motion rotary", "--motion: the device file says it");
}

TEST_F(Relay, RefusesRecordingsThatDoNotFit) {
  write("run.csv", [] {
    std::string rows = "t,f,x,v\n";
    for (int k = 0; k < 4000; ++k) {
      const double phase = 2.0 * 3.14159265358979 * 5.0 * 1e-3 * k + 1e-4;
      rows += std::to_string(1e-3 * k) + "," + (std::sin(phase) > 0 ? "-5" : "5") + "," +
              std::to_string(std::sin(phase)) + "," + std::to_string(std::cos(phase)) + "\n";
    }
    return rows;
  }());
  const std::string recording = "--recording run.csv ";
  expect_refused(recording + "--position x", "--force: missing");
  expect_refused(recording + "--force f", "--position: missing");
  expect_refused(recording + "--force f --velocity v", "--velocity: a relay acts on the position");
  expect_refused(recording + "--force f --position y", "--position: run.csv: y: no such column");
  expect_refused(recording + "--force f --position x --amplitude 5", "--amplitude: is about a simulation");
  expect_refused(recording + "--force f --position x --delay 1e-3", "--delay: is about a device");
  expect_refused("--recording nowhere.csv --force f --position x", "nowhere.csv");
  expect_refused(recording + "--force f --position x --figure run.csv", "--figure: run.csv: unknown extension");
  expect_refused("devices/lhifam.toml --set loop.sampling_period=2e-3 " + recording + "--force f --position x",
                 "devices/lhifam.toml: loop.sampling_period");
  EXPECT_EQ(run("zwidth relay --recording run.csv --force f --position x").status, 0);
}

}  // namespace
}  // namespace zwidth::cli
