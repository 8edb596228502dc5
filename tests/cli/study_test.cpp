#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

const std::string lhifam = "zwidth study devices/lhifam.toml --study devices/studies/lhifam.toml";

class Study : public Workspace {
 protected:
  [[nodiscard]] nlohmann::json document(const std::string& command) const {
    const Outcome outcome = run(command + " --json");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_THAT(outcome.errors, IsEmpty());
    return nlohmann::json::parse(outcome.output, nullptr, false);
  }
  /// Names of the files beside the result that a study leaves behind.
  [[nodiscard]] int partial_files() const {
    int count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(directory())) {
      const std::string name = entry.path().filename().string();
      count += name.find(".part") != std::string::npos ? 1 : 0;
    }
    return count;
  }
};

TEST_F(Study, SaysWhatShareOfTheUnitsIsGoodEnough) {
  const auto answer = document(lhifam + " --samples 500 --index-samples 64 --output-device worst.toml");
  EXPECT_EQ(answer["schema"], "zwidth.study/1");
  EXPECT_EQ(answer["samples"], 500);
  EXPECT_EQ(answer["trust"]["verdict"], "sound");
  EXPECT_LE(answer["yield_interval"][0], answer["yield"]);
  EXPECT_GE(answer["yield_interval"][1], answer["yield"]);
  EXPECT_EQ(answer["failed_count"], 0);
  EXPECT_TRUE(answer["sobol_indices"].is_null());  // the parameters are correlated
  double before = 0.0;
  for (const auto& quantile : answer["quantiles"]) {
    const bool is_known = !quantile["interval"][0].is_null() && !quantile["interval"][1].is_null();
    EXPECT_EQ(quantile["status"], is_known ? "finite" : "too_few_samples") << quantile;
    EXPECT_EQ(quantile["stiffness"].is_number(), is_known) << quantile;
    if (!is_known) continue;
    EXPECT_GE(quantile["stiffness"], before);
    before = quantile["stiffness"];
  }
  EXPECT_GT(before, 0.0);
  // The worst unit is a device of its own, with that limit.
  EXPECT_LE(answer["worst"]["critical_stiffness"], answer["worst"]["worst_sampled"]);
  const auto worst = document("zwidth analyze worst.toml");
  EXPECT_NEAR(worst["critical_stiffness"].get<double>() / answer["worst"]["critical_stiffness"].get<double>(), 1.0,
              1e-12);
  const Outcome text = run(lhifam + " --samples 500 --index-samples 64");
  EXPECT_THAT(text.output, HasSubstr("of the units reach a K_CR of 6 kN/m (95 % interval "));
  EXPECT_THAT(text.output, HasSubstr("Worst unit: K_CR "));
}

TEST_F(Study, ResultFileIsTheSameForAnyThreadsAndInMemory) {
  const std::string many = lhifam + " --samples 10000 --index-samples 0 --json";
  const Outcome one = run(many + " --threads 1 --output one.h5");
  ASSERT_EQ(one.status, 0) << one.errors;
  const Outcome three = run(many + " --threads 3 --output three.h5");
  EXPECT_THAT(three.errors, IsEmpty());
  EXPECT_EQ(one.output, three.output);
  EXPECT_EQ(contents("one.h5"), contents("three.h5"));
  EXPECT_FALSE(contents("one.h5").empty());
  EXPECT_EQ(run(many).output, one.output);
  EXPECT_EQ(partial_files(), 0);
}

// Killed again and again at random instants, it loses no more than what was being computed, and ends the same.
TEST_F(Study, GoesOnAfterAnyKill) {
  const std::string many = lhifam + " --samples 200000 --index-samples 0 --json --threads 2";
  const auto started = std::chrono::steady_clock::now();
  const Outcome whole = run(many + " --output whole.h5");
  const double whole_duration = std::chrono::duration<double>(std::chrono::steady_clock::now() - started).count();
  ASSERT_EQ(whole.status, 0) << whole.errors;
  constexpr unsigned seed = 20261123;
  SCOPED_TRACE(seed);
  std::mt19937 random(seed);
  int killed = 0;
  Outcome outcome;
  for (int attempt = 0; attempt < 12; ++attempt) {
    // The first one early, so that it is within the run on any machine.
    const double seconds = whole_duration * (attempt == 0 ? 0.3 : std::uniform_real_distribution(0.05, 0.6)(random));
    outcome = run("timeout -s KILL " + std::to_string(seconds) + " " + many + " --output killed.h5" +
                  (attempt > 0 ? " --resume" : ""));
    if (outcome.status == 0) break;
    ++killed;
  }
  EXPECT_GT(killed, 0);
  // What was being written when it was killed may be half there: damage the end too.
  if (outcome.status != 0) {
    (void)run("[ ! -s killed.h5.partial.0 ] || truncate -s -5 killed.h5.partial.0");
    outcome = run(many + " --output killed.h5 --resume");
  }
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(outcome.output, whole.output);
  EXPECT_EQ(contents("killed.h5"), contents("whole.h5"));
  EXPECT_EQ(partial_files(), 0);
}

TEST_F(Study, KeepsACheckpointOfAnotherStudy) {
  const std::string short_one = lhifam + " --samples 9000 --index-samples 0 --output units.h5";
  (void)run("timeout -s KILL 0.6 " + lhifam + " --samples 2000000 --output units.h5");
  ASSERT_TRUE(std::filesystem::exists(directory() / "units.h5.partial.0"));
  const std::string before = contents("units.h5.partial.0");
  expect_refusal(short_one, "--output: units.h5.partial.0: a study was ended before it was done; add --resume");
  expect_refusal(short_one + " --resume",
                 "units.h5.partial.0: is of another study: it has \"samples: 2000000\", this one \"samples: 9000\"");
  expect_refusal(lhifam + " --samples 2000000 --seed 2 --output units.h5 --resume",
                 "it has \"seed: 1\", this one \"seed: 2\"");
  EXPECT_EQ(contents("units.h5.partial.0"), before);
  std::string other = before;
  other.replace(other.find("version: ") + 9, 1, "9");
  write("units.h5.partial.0", other);
  expect_refusal(lhifam + " --samples 2000000 --output units.h5 --resume", "it has \"version: 9");
  const std::string resumed = lhifam + " --samples 2000000 --output units.h5 --resume";
  write("units.h5.partial.0", before.substr(0, before.find("seed: ")) + "seed: 17\n");  // killed at its first bytes
  expect_refusal(resumed, "is of another study: it has \"seed: 17\", this one \"seed: 1\"");
  write("units.h5.partial.0", "zwidth study checkpoint 1" + before.substr(before.find('\n')));
  expect_refusal(resumed, "is of another study: it has \"zwidth study checkpoint 1\"");
  write("units.h5.partial.0", "something else entirely, of nobody's");
  expect_refusal(lhifam + " --samples 2000000 --output units.h5 --resume", "is no checkpoint of this program");
}

TEST_F(Study, RefusesBadInputWithItsPlace) {
  write("wrong.toml", "[[parameter]]\nkey = \"link.stifness\"\n");
  expect_refusal("zwidth study devices/lhifam.toml --study wrong.toml",
                 "wrong.toml:2:7: parameter.0.key: \"link.stifness\" is no number of the device");
  expect_refusal("zwidth study devices/lhifam.toml --study none.toml", "none.toml: ");
  expect_refusal(lhifam + " --samples 0", "--samples: is 0; must be 1 to ");
  expect_refusal(lhifam + " --resume", "--resume: goes on with a result that was begun; add --output FILE.h5");
  expect_refusal(lhifam + " --output units.csv", "--output: units.csv: unknown extension of a result; .h5");
  expect_refusal("ln -s devices/studies/lhifam.toml study.h5; " + lhifam + " --output study.h5",
                 "would overwrite the study file");
  expect_refusal("ln -s devices/lhifam.toml device.h5; " + lhifam + " --output device.h5",
                 "would overwrite the device file");
}

TEST_F(Study, ADiskThatFailsKeepsWhatThereIs) {
  const Outcome missing = run(lhifam + " --samples 100 --output nowhere/units.h5");
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(missing.errors, HasSubstr("cannot write: No such file or directory; make the folder first"));
  const Outcome long_name = run(lhifam + " --samples 100 --output " + std::string(300, 'u') + ".h5");
  EXPECT_EQ(long_name.status, 1);
  EXPECT_THAT(long_name.errors, HasSubstr("uuu.h5.partial.0: cannot write: File name too long"));
  // A disk of 200 kB: the checkpoint does not fit, what does is kept, and the study goes on elsewhere.
  const Outcome mounted =
      run("mkdir small && unshare -m bash -c 'mount -t tmpfs -o size=200k none small && " + lhifam +
          " --samples 60000 --index-samples 0 --output small/units.h5; echo $? > status; cp small/* .'");
  if (contents("status").empty()) GTEST_SKIP() << "no right to mount a small disk";
  EXPECT_EQ(contents("status"), "1\n");
  EXPECT_THAT(mounted.errors,
              HasSubstr("No space left on device; make room and add --resume: what was computed is kept"));
  EXPECT_THAT(mounted.errors, StartsWith("zwidth: "));
  ASSERT_TRUE(std::filesystem::exists(directory() / "units.h5.partial.0"));
  const Outcome resumed = run(lhifam + " --samples 60000 --index-samples 0 --output units.h5 --resume");
  EXPECT_EQ(resumed.status, 0) << resumed.errors;
}

// The checkpoint fits, the result beside it does not.
TEST_F(Study, ADiskThatIsFullAtTheEndKeepsWhatThereIs) {
  const std::string many = lhifam + " --samples 60000 --index-samples 0 --output ";
  ASSERT_EQ(run(many + "whole.h5").status, 0);
  const Outcome mounted = run("mkdir small && unshare -m bash -c 'mount -t tmpfs -o size=2000k none small && " + many +
                              "small/units.h5; echo $? > status; cp small/* .'");
  if (contents("status").empty()) GTEST_SKIP() << "no right to mount a small disk";
  EXPECT_EQ(contents("status"), "1\n");
  EXPECT_THAT(mounted.errors, StartsWith("zwidth: small/units.h5: cannot write: No space left on device; make room"));
  EXPECT_FALSE(std::filesystem::exists(directory() / "units.h5.part"));
  ASSERT_TRUE(std::filesystem::exists(directory() / "units.h5.partial.0"));
  const Outcome resumed = run(many + "units.h5 --resume");
  EXPECT_EQ(resumed.status, 0) << resumed.errors;
  EXPECT_EQ(contents("units.h5"), contents("whole.h5"));
}

TEST_F(Study, AFolderThatMayNotBeWrittenToIsNamed) {
  const Outcome mounted =
      run("mkdir fixed && unshare -m bash -c 'mount -t tmpfs none fixed && mount -o remount,ro fixed && " + lhifam +
          " --samples 100 --output fixed/units.h5; echo $? > status'");
  if (contents("status").empty()) GTEST_SKIP() << "no right to mount";
  EXPECT_EQ(contents("status"), "1\n");
  EXPECT_THAT(mounted.errors, StartsWith("zwidth: fixed/units.h5.partial.0: cannot write: Read-only file system; "
                                         "name a file in a folder that you may write to"));
}

// A disk that lies: what follows a damaged record is computed again.
TEST_F(Study, ComputesAgainWhatIsDamaged) {
  const std::string many = lhifam + " --samples 400000 --index-samples 0 --json --threads 1 --output ";
  const Outcome whole = run(many + "whole.h5");
  ASSERT_EQ(whole.status, 0) << whole.errors;
  (void)run("(" + many +
            "units.h5 > /dev/null 2>&1 & for i in $(seq 2000); do [ \"$(stat -c %s units.h5.partial.0 "
            "2> /dev/null || echo 0)\" -gt 500000 ] && break; sleep 0.005; done; kill -9 $!)");
  std::string checkpoint = contents("units.h5.partial.0");
  ASSERT_GT(checkpoint.size(), 500000U);
  checkpoint[checkpoint.size() / 2] = static_cast<char>(checkpoint[checkpoint.size() / 2] ^ 4);
  write("units.h5.partial.0", checkpoint);
  const Outcome resumed = run(many + "units.h5 --resume");
  ASSERT_EQ(resumed.status, 0) << resumed.errors;
  EXPECT_EQ(resumed.output, whole.output);
  EXPECT_EQ(contents("units.h5"), contents("whole.h5"));
}

TEST_F(Study, LeavesAStudyAloneThatAnotherProcessIsAt) {
  const std::string many = lhifam + " --samples 3000000 --index-samples 0 --output units.h5";
  const Outcome second = run("(timeout 20 " + many +
                             " > /dev/null 2>&1 & echo $! > first); for i in $(seq 200); do [ -s "
                             "units.h5.partial.0 ] && break; sleep 0.05; done; " +
                             many + "; echo $? > status; " + many + " --resume; kill $(cat first)");
  EXPECT_EQ(contents("status"), "2\n");
  EXPECT_THAT(second.errors, HasSubstr("units.h5.partial.0: another process is at this study; wait for it"));
  EXPECT_THAT(second.errors, Not(HasSubstr("remove that file")));
}

TEST_F(Study, AFolderIsNoResult) {
  expect_refusal("mkdir units && " + lhifam + " --samples 100 --output units",
                 "--output: units: is a folder; name a file");
  EXPECT_EQ(partial_files(), 0);
}

// HDF5 has no slash in a name.
TEST_F(Study, TakesBodiesOfAnyName) {
  write("named.toml", "[[body]]\nname = \"a/b %\"\nmass = 1\ndamping = 2\n[loop]\nsampling_period = 1e-3\n");
  write("spread.toml",
        "[[parameter]]\nkey = \"body.a/b %.mass\"\ndistribution = \"uniform\"\nrelative_tolerance = 0.1\n");
  const Outcome outcome = run("zwidth study named.toml --study spread.toml --samples 100 --output units.h5");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(contents("units.h5"), HasSubstr("body.a%2Fb %25.mass"));
  EXPECT_EQ(partial_files(), 0);
}

TEST_F(Study, WritesAPageWithFigures) {
  write(
      "free.toml",
      "[specification]\ncritical_stiffness = 7000\n[[parameter]]\nkey = \"link.stiffness\"\ndistribution = \"normal\"\n"
      "relative_deviation = 0.1\n[[parameter]]\nkey = \"body.handle.damping\"\ndistribution = \"uniform\"\nlower = "
      "2\nupper = 4\n");
  const Outcome outcome =
      run("zwidth study devices/lhifam.toml --study free.toml --samples 300 --index-samples 32 --report page.html");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const std::string page = contents("page.html");
  for (const char* part : {"Bars: units by their critical stiffness", "Sobol indices", "coloured by what limits it",
                           "The worst unit", "</html>"}) {
    EXPECT_THAT(page, HasSubstr(part));
  }
}

TEST_F(Study, AFigureOfNothingTakesNoAnswerWithIt) {
  write("one.toml", "[[parameter]]\nkey = \"link.damping\"\ndistribution = \"discrete\"\nvalues = [15.0]\n");
  const Outcome outcome =
      run("zwidth study devices/lhifam.toml --study one.toml --samples 100 --index-samples 0 --csv units.csv --figure "
          "units.svg");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.errors, HasSubstr("--figure: "));
  EXPECT_THAT(outcome.output, HasSubstr("100"));
  EXPECT_NE(contents("units.csv"), "");
  EXPECT_EQ(contents("units.svg"), "");
}

// Without Sobol indices, as of correlated parameters, what a tighter tolerance gains; numbers with their prefix.
TEST_F(Study, DrawsWhichToleranceToTighten) {
  ASSERT_EQ(run(lhifam + " --samples 400 --report page.html").status, 0);
  const std::string page = contents("page.html");
  EXPECT_THAT(page, HasSubstr("Yield gained where one parameter has half its spread"));
  EXPECT_THAT(page, HasSubstr("link.stiffness (kN/m)"));
  EXPECT_THAT(page, Not(HasSubstr("-0.000 ±")));
}

TEST_F(Study, SaysWhichWallsSharesOfTheUnitsRender) {
  const std::string asked = lhifam + " --samples 400 --index-samples 0 --region-units 400";
  const auto regions = document(asked + " --report page.html")["regions"];
  EXPECT_EQ(regions["units"], 400);
  EXPECT_EQ(regions["trust"]["verdict"], "sound");
  const auto& dampings = regions["dampings"];
  EXPECT_NEAR(dampings[1].get<double>(), regions["damping_step"].get<double>(), 1e-12);
  ASSERT_EQ(regions["contours"].size(), 3U);
  for (const auto& contour : regions["contours"]) {
    ASSERT_EQ(contour["stiffness"].size(), dampings.size());
    for (std::size_t i = 0; i < dampings.size(); ++i) {
      EXPECT_LE(contour["lower"][i], contour["stiffness"][i]);
      EXPECT_LE(contour["stiffness"][i], contour["upper"][i]);
    }
  }
  EXPECT_THAT(contents("page.html"), HasSubstr("stable for 99 % of the units"));
  EXPECT_THAT(run(asked).output, HasSubstr("Walls (K, B) of 400 units, at dampings in steps of "));
  EXPECT_TRUE(document(lhifam + " --samples 100 --index-samples 0")["regions"].is_null());
  expect_refusal(lhifam + " --region-units 300", "--region-units: is 300; must be 0, or 368 to 1048576");
}

// Real processes, as many as asked for, meet at one result.
TEST_F(Study, IsTheSameForAnyNumberOfRanks) {
  if (run("command -v zwidth-study mpirun").status != 0) GTEST_SKIP() << "built without MPI";
  const std::string arguments =
      " devices/lhifam.toml --study devices/studies/lhifam.toml --samples 30000 --index-samples 0 --threads 1 --json";
  const Outcome alone = run("zwidth study" + arguments + " --output alone.h5");
  ASSERT_EQ(alone.status, 0) << alone.errors;
  for (const std::string ranks : {"1", "2", "3"}) {
    const Outcome together = run("mpirun --allow-run-as-root --oversubscribe -n " + ranks + " zwidth-study" +
                                 arguments + " --output ranks.h5");
    ASSERT_EQ(together.status, 0) << together.errors;
    EXPECT_EQ(together.output, alone.output) << ranks;
    EXPECT_EQ(contents("ranks.h5"), contents("alone.h5")) << ranks;
  }
  EXPECT_EQ(partial_files(), 0);
}

TEST_F(Study, OfSeveralRanksTellsItsVersionAndItsOptions) {
  if (run("command -v zwidth-study mpirun").status != 0) GTEST_SKIP() << "built without MPI";
  const Outcome version = run("zwidth-study --version");
  EXPECT_EQ(version.status, 0) << version.errors;
  EXPECT_EQ(version.output, run("zwidth --version").output);
  const Outcome help = run("zwidth-study --help");
  EXPECT_EQ(help.status, 0) << help.errors;
  EXPECT_EQ(help.output, run("zwidth study --help").output);
}

// A rank that is killed ends the run; what all of them had done is there for the next one, of any number of ranks.
TEST_F(Study, GoesOnAfterALostRank) {
  if (run("command -v zwidth-study mpirun").status != 0) GTEST_SKIP() << "built without MPI";
  const std::string arguments =
      " devices/lhifam.toml --study devices/studies/lhifam.toml --samples 1000000 --index-samples 0 --threads 1 --json";
  const Outcome alone = run("zwidth study" + arguments + " --output alone.h5");
  const Outcome lost =
      run("mpirun --allow-run-as-root --oversubscribe -n 2 bash -c 'if [ $OMPI_COMM_WORLD_RANK = 1 ]; then (for i in "
          "$(seq 1000); "
          "do [ -s lost.h5.partial.1 ] && break; sleep 0.01; done; kill -9 $$) & fi; exec zwidth-study" +
          arguments + " --output lost.h5'");
  ASSERT_NE(lost.status, 0);
  ASSERT_GT(partial_files(), 0);
  const Outcome resumed = run("zwidth study" + arguments + " --output lost.h5 --resume");
  EXPECT_EQ(resumed.status, 0) << resumed.errors;
  EXPECT_EQ(resumed.output, alone.output);
  EXPECT_EQ(contents("lost.h5"), contents("alone.h5"));
  EXPECT_EQ(partial_files(), 0);
}

}  // namespace
}  // namespace zwidth::cli
