// The program's frame: help, version, usage errors, exit statuses, standard output that cannot be written.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "cli/workspace_with_help.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

using Frame = WorkspaceWithHelp;

/// The command lines after "Examples:" in a help text.
std::vector<std::string> examples_in(const std::string& help) {
  std::vector<std::string> examples;
  std::istringstream lines(help.substr(std::min(help.find("Examples:"), help.size())));
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("  zwidth ")) continue;
    examples.push_back(line.substr(2));
    while (examples.back().ends_with('\\') && std::getline(lines, line)) examples.back() += "\n" + line;
  }
  return examples;
}

#ifdef ZWIDTH_MUJOCO
constexpr bool reads_mechanisms = true;
#else
constexpr bool reads_mechanisms = false;
#endif

/// A server runs until it is interrupted: here when it has told its address, at any free port and without a browser. A device
/// is identified from a record of 4 s.
std::string runnable(std::string example) {
  if (example.starts_with("zwidth rig identify")) return example + " --duration 4";
  if (!example.starts_with("zwidth serve")) return example;
  if (const std::size_t opens = example.find(" --open"); opens != std::string::npos) example.erase(opens, 7);
  return "rm -f address; " + example +
         " --port 0 > address & until [ -s address ]; do sleep 0.05; done; kill -INT $!; wait $!";
}

TEST_F(Frame, EveryHelpHasExamplesAndEachOfThemWorks) {
  std::vector<std::string> helps = {"zwidth --help"};
  for (const std::string& command : commands()) helps.push_back("zwidth " + command + " --help");
  ASSERT_GT(helps.size(), 1U);
  for (const std::string& help : helps) {
    const Outcome shown = run(help);
    EXPECT_EQ(shown.status, 0) << help;
    EXPECT_THAT(shown.errors, IsEmpty()) << help;
    const auto examples = examples_in(shown.output);
    EXPECT_FALSE(examples.empty()) << help;
    for (const std::string& example : examples) {
      if (!reads_mechanisms && example.find("devices/mechanisms") != std::string::npos) continue;
      const Outcome outcome = run(runnable(example));
      EXPECT_EQ(outcome.status, 0) << example << "\n" << outcome.errors;
      EXPECT_THAT(outcome.errors, IsEmpty()) << example;
    }
  }
}

TEST_F(Frame, HelpFitsOneHundredColumns) {
  for (const std::string& command : commands()) {
    std::istringstream lines(run("zwidth " + command + " --help").output);
    for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 100U) << line;
  }
}

TEST_F(Frame, VersionIsOneLine) {
  const Outcome outcome = run("zwidth --version");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.output, ::testing::MatchesRegex("zwidth [0-9]+\\.[0-9]+\\.[0-9]+ \\((unknown|[0-9a-z.-]+)\\)\n"));
}

TEST_F(Frame, WithoutArgumentsItExplainsItself) {
  const Outcome outcome = run("zwidth");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.output, IsEmpty());
  EXPECT_THAT(outcome.errors, HasSubstr("zwidth analyze devices/lhifam.toml"));
  EXPECT_THAT(outcome.errors, HasSubstr("Commands: analyze, bode, design,"));
  EXPECT_THAT(outcome.errors, HasSubstr("zwidth COMMAND --help"));
  EXPECT_LE(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 12);
}

TEST_F(Frame, WrongUsageExitsWithTwoAndSaysWhatWasMeant) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"zwidth analyse devices/lhifam.toml", "zwidth: unknown command analyse; did you mean analyze?"},
      {"zwidth qqqqqqq", "zwidth: unknown command qqqqqqq; commands are analyze"},
      {"zwidth --versoin", "zwidth: unknown option --versoin; did you mean --version?"},
      {"zwidth analyze --jsn devices/lhifam.toml", "zwidth: unknown option --jsn; did you mean --json?"},
      {"zwidth analyze devices/lhifam.toml --reprot=x.html", "zwidth: unknown option --reprot; did you mean --report?"},
      {"zwidth analyze -q devices/lhifam.toml", "zwidth: unknown option -q; see zwidth analyze --help"},
      {"zwidth --", "zwidth: no command given; commands are analyze"},
      {"zwidth analyze", "zwidth: analyze: FILE is required; see zwidth analyze --help"},
      {"zwidth analyze devices/lhifam.toml --set", "zwidth: analyze: --set"},
      {"zwidth analyze devices/lhifam.toml --json=perhaps", "zwidth: analyze: "},
      {"zwidth analyze ''", "zwidth: "},
      {"zwidth analyze - -", "zwidth: standard input (-) is given more than once"},
  };
  for (const auto& [command_line, message] : cases) {
    const Outcome outcome = run(command_line);
    EXPECT_EQ(outcome.status, 2) << command_line;
    EXPECT_THAT(outcome.output, IsEmpty()) << command_line;
    EXPECT_THAT(outcome.errors, StartsWith(message)) << command_line;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  }
}

TEST_F(Frame, NoCommandOverwritesItsDeviceFile) {
  write("device.csv", run("cat devices/lhifam.toml").output);
  write("device.html", run("cat devices/lhifam.toml").output);
  for (const std::string command :
       {"analyze device.html --report ./device.html", "bode device.csv --output ./device.csv",
        "export device.csv --format json --output ./device.csv"}) {
    const Outcome outcome = run("zwidth " + command);
    EXPECT_EQ(outcome.status, 2) << command;
    EXPECT_THAT(outcome.errors, HasSubstr("would overwrite the device file")) << command;
  }
  EXPECT_EQ(run("cmp device.csv devices/lhifam.toml").status, 0);
}

TEST_F(Frame, OutputHasNoColour) {
  for (const std::string environment : {"", "NO_COLOR=1 ", "CLICOLOR_FORCE=1 "}) {
    const Outcome outcome = run(environment + "zwidth analyze devices/lhifam.toml");
    EXPECT_EQ(outcome.status, 0);
    EXPECT_THAT(outcome.output, Not(HasSubstr("\x1b")));
    EXPECT_THAT(outcome.errors, IsEmpty());
  }
}

TEST_F(Frame, AFullOrClosedStandardOutputIsAFailureOfTheWork) {
  for (const std::string arguments :
       {"--help", "--version", "analyze devices/lhifam.toml", "analyze devices/lhifam.toml --json", "analyze --help"}) {
    const Outcome full = run("zwidth " + arguments + " > /dev/full");
    EXPECT_EQ(full.status, 1) << arguments;
    EXPECT_EQ(full.errors, "zwidth: standard output: cannot write: No space left on device\n") << arguments;
    const Outcome closed = run("zwidth " + arguments + " >&-");
    EXPECT_EQ(closed.status, 1) << arguments;
    EXPECT_EQ(closed.errors, "zwidth: standard output: cannot write: Bad file descriptor\n") << arguments;
  }
}

TEST_F(Frame, AFailureOfTheWorkNamesARemedy) {
  const Outcome missing = run("zwidth export devices/lhifam.toml --format json --output no/such.json");
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(missing.errors, HasSubstr("make the folder first"));
  const Outcome too_large = run("ulimit -f 1; zwidth export devices/lhifam.toml --format json --output large.json");
  EXPECT_EQ(too_large.status, 1);
  EXPECT_THAT(too_large.errors, HasSubstr("File too large; raise the limit"));
  EXPECT_FALSE(std::filesystem::exists(directory() / "large.json"));
}

TEST_F(Frame, AReaderThatGoesAwayIsNoFailure) {
  const Outcome outcome = run("set -o pipefail\n(sleep 0.2; zwidth analyze devices/lhifam.toml) | true");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.errors, IsEmpty());
}

TEST_F(Frame, ClosedStandardErrorDoesNotCrash) {
  EXPECT_EQ(run("zwidth analyze missing.toml 2>&-").status, 2);
  EXPECT_EQ(run("zwidth analyze missing.toml 2>/dev/full").status, 2);
  EXPECT_EQ(run("zwidth analyze - <&-").status, 2);
}

}  // namespace
}  // namespace zwidth::cli
