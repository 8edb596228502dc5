// Completions and manual pages: what the program's own help says, in the shells and in man.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "cli/workspace_with_help.hpp"

namespace zwidth::cli {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Words = std::set<std::string>;

Words words_in(const std::string& lines) {
  std::istringstream stream(lines);
  Words words;
  for (std::string line; std::getline(stream, line);) words.insert(line);
  return words;
}

class GeneratedFiles : public WorkspaceWithHelp {
 protected:
  /// The options that the help of a command begins a line with.
  [[nodiscard]] Words options(const std::string& command) const {
    Words found;
    std::istringstream help(run("zwidth " + command + " --help").output);
    for (std::string line; std::getline(help, line) && line != "Examples:";) {
      if (!line.starts_with("  -")) continue;
      std::istringstream names(line.substr(2, line.find(' ', 2) - 2));
      for (std::string name; std::getline(names, name, ',');) found.insert(name);
    }
    return found;
  }

  /// What bash offers for the last of the words.
  [[nodiscard]] Words completed(const std::string& words) const {
    const Outcome outcome = run("source <(zwidth --generate bash)\nCOMP_WORDS=(" + words +
                                ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_zwidth\n"
                                "(( ${#COMPREPLY[@]} == 0 )) || printf '%s\\n' \"${COMPREPLY[@]}\"");
    EXPECT_EQ(outcome.status, 0) << words;
    EXPECT_THAT(outcome.errors, IsEmpty()) << words;
    return words_in(outcome.output);
  }
};

TEST_F(GeneratedFiles, BashCompletesWhatTheHelpHas) {
  const auto names = commands();
  ASSERT_GT(names.size(), 5U);
  EXPECT_EQ(completed("zwidth ''"), Words(names.begin(), names.end()));
  EXPECT_EQ(completed("zwidth an"), Words{"analyze"});
  for (const std::string& command : names) {
    const Words from_help = options(command);
    ASSERT_GE(from_help.size(), 2U) << command;
    EXPECT_EQ(completed("zwidth " + command + " -"), from_help) << command;
  }
  EXPECT_EQ(completed("zwidth simulate devices/lhifam.toml --cont"), Words{"--contact"});
}

TEST_F(GeneratedFiles, BashCompletesValuesAndFiles) {
  const Words kinds{"bilateral", "unilateral"};
  EXPECT_EQ(completed("zwidth simulate --contact ''"), kinds);
  EXPECT_EQ(completed("zwidth simulate --contact ="), kinds);  // --contact=
  EXPECT_EQ(completed("zwidth simulate --contact = uni"), Words{"unilateral"});
  EXPECT_EQ(completed("zwidth simulate --duration ''"), Words{});
  EXPECT_EQ(completed("zwidth analyze --set loop."),
            (Words{"loop.actuated=", "loop.sensed=", "loop.held=", "loop.sampling_period=", "loop.delay=",
                   "loop.damper.sampling_period=", "loop.damper.delay="}));
  EXPECT_EQ(completed("zwidth design --sweep body.0.m"), Words{"body.0.mass="});
  write("a b.toml", "");
  EXPECT_EQ(completed("zwidth analyze 'a '"), Words{"a b.toml"});
  EXPECT_EQ(completed("zwidth analyze devices/lhifam_r"),
            (Words{"devices/lhifam_reduced_pretension.toml", "devices/lhifam_rigid.toml"}));
  EXPECT_EQ(completed("zwidth excite --device devices/emp"), Words{"devices/emps.toml"});
  EXPECT_EQ(completed("zwidth rig ''"), (Words{"check", "identify", "limit", "measure", "relay", "wall"}));
  EXPECT_EQ(completed("zwidth rig me"), Words{"measure"});
  EXPECT_EQ(completed("zwidth rig wall devices/emp"), Words{"devices/emps.toml"});
}

TEST_F(GeneratedFiles, BashTakesThemAtAPrompt) {
  // Through readline, as a user types it: TAB after the unfinished command.
  const Outcome outcome =
      run("zwidth --generate bash > completion; printf 'source completion\\nzwidth simu\\t--vers\\nexit\\n' | "
          "bash --norc -i 2>&1 || true");
  EXPECT_THAT(outcome.output, HasSubstr("zwidth simulate --vers"));
}

TEST_F(GeneratedFiles, OtherShellsReadTheirs) {
  for (const std::string shell : {"zsh", "fish"}) {
    if (run("command -v " + shell).status != 0)
      FAIL() << "there is no " << shell << ": scripts/install-dependencies tests";
    const Outcome outcome = run("zwidth --generate " + shell + " > file && " + shell + " -n file");
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_THAT(outcome.errors, IsEmpty());
  }
  const Outcome fish = run("fish -c \"source file; complete -C 'zwidth simulate --contact '\" | cut -f1");
  EXPECT_EQ(words_in(fish.output), (Words{"bilateral", "unilateral"})) << fish.errors;
  const Outcome keys = run("fish -c \"source file; complete -C 'zwidth analyze --set wall.velocity'\" | cut -f1");
  EXPECT_EQ(words_in(keys.output), (Words{"wall.velocity_filter_hz=", "wall.velocity_filter_tau="})) << keys.errors;
  const Outcome actions = run("fish -c \"source file; complete -C 'zwidth rig '\" | cut -f1");
  EXPECT_EQ(words_in(actions.output), (Words{"check", "identify", "limit", "measure", "relay", "wall"}));
  const Outcome files = run("fish -c \"source file; complete -C 'zwidth rig wall devices/emp'\" | cut -f1");
  EXPECT_EQ(words_in(files.output), Words{"devices/emps.toml"});
  const Outcome zsh = run("zsh -fc 'autoload -Uz compinit && compinit -u -D && source <(zwidth --generate zsh)'");
  EXPECT_EQ(zsh.status, 0);
  EXPECT_THAT(zsh.errors, IsEmpty());
}

TEST_F(GeneratedFiles, ManualPagesRenderAndHaveEveryOption) {
  if (run("command -v groff").status != 0) FAIL() << "there is no groff: scripts/install-dependencies tests";
  for (const std::string& command : commands()) {
    const Outcome page = run("zwidth --generate man-" + command + " > page.1 && groff -man -ww -Tascii -P-cbou page.1");
    EXPECT_EQ(page.status, 0) << command;
    EXPECT_THAT(page.errors, IsEmpty()) << command;
    for (const std::string& option : options(command)) {
      EXPECT_THAT(page.output, AnyOf(HasSubstr("       " + option), HasSubstr(", " + option))) << command;
    }
    EXPECT_THAT(page.output, HasSubstr("\nEXAMPLES\n       zwidth " + command)) << command;
    const Outcome man = run("command -v man > /dev/null || exit 0; MANWIDTH=100 man --warnings -l page.1 > /dev/null");
    EXPECT_EQ(man.status, 0) << command;
    EXPECT_THAT(man.errors, IsEmpty()) << command;
  }
  const Outcome program = run("zwidth --generate man | groff -man -ww -Tascii -P-cbou");
  EXPECT_THAT(program.errors, IsEmpty());
  for (const std::string& command : commands()) EXPECT_THAT(program.output, HasSubstr("zwidth-" + command + "(1)"));
}

TEST_F(GeneratedFiles, AnotherKindIsRefused) {
  expect_refusal("zwidth --generate tcsh", "--generate: is tcsh; bash, zsh, fish, man, ");
}

/// What a user reads in a locale without UTF-8 has ASCII letters alone; what a program reads does not change.
TEST_F(GeneratedFiles, TextIsAsciiWhereTheLocaleIs) {
  const std::string rotary = "devices/quanser_torsion.toml --set wall.stiffness=5 --set 'name=\"D\u00edaz\"'";
  const std::vector<std::string> answers = {"analyze " + rotary,
                                            "design " + rotary,
                                            "region " + rotary,
                                            "simulate " + rotary,
                                            "bode " + rotary,
                                            "relay " + rotary + " --amplitude 1",
                                            "analyze devices/quanser_torsion.toml devices/lhifam.toml",
                                            "frf recordings/locked_chirp.csv --force force --position position",
                                            "excite --amplitude 2 --json",
                                            "design " + rotary + " --sweep loop.delay=0:8e-3:3",
                                            "design devices/lhifam.toml --target 12000",
                                            "design devices/lhifam.toml --recommend",
                                            "diagnose " + rotary + " --oscillates-hz 19"};
  for (const std::string& command : answers) {
    const Outcome plain = run("LC_ALL=C zwidth " + command);
    EXPECT_EQ(plain.status, 0) << command << plain.errors;
    for (const std::string* text : {&plain.output, &plain.errors}) {
      EXPECT_TRUE(std::ranges::all_of(*text, [](char c) { return static_cast<unsigned char>(c) < 0x80; }))
          << command << "\n"
          << *text;
    }
  }
  EXPECT_THAT(run("LC_ALL=C.UTF-8 zwidth analyze " + rotary).output, HasSubstr("500 \u00b5s"));
  EXPECT_THAT(run("LC_ALL=C zwidth analyze " + rotary).output, HasSubstr("500 us"));
  EXPECT_EQ(run("LC_ALL=C zwidth analyze --json " + rotary).output,
            run("LC_ALL=C.UTF-8 zwidth analyze --json " + rotary).output);
  const Outcome refused = run("LC_ALL=C zwidth analyze devices/lhifam.toml --set 'loop.delay=5 \u00b5m'");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("\"um\" is no unit of a time"));
}

/// Descriptions are broken beside their options; commands to copy are not.
TEST_F(GeneratedFiles, HelpIsAsWideAsTheTerminal) {
  for (const std::string& command : commands()) {
    std::istringstream lines(run("COLUMNS=60 zwidth " + command + " --help").output);
    for (std::string line; std::getline(lines, line) && line != "Examples:";) {
      const bool is_of_options = line.starts_with("  ") && line.find_first_not_of(' ') < 30;
      if (line.starts_with("Usage:") || is_of_options) continue;
      EXPECT_LE(line.size(), 60u) << command << ": " << line;
    }
    const auto words = [&](const std::string& environment) {
      std::istringstream help(run(environment + "zwidth " + command + " --help").output);
      return std::vector<std::string>(std::istream_iterator<std::string>(help), {});
    };
    EXPECT_EQ(words("COLUMNS=60 "), words("")) << command;
  }
  EXPECT_THAT(run("COLUMNS=60 zwidth analyze --help").output,
              HasSubstr("  --json                      Print one JSON document per\n"
                        "                              device, one per line\n"));
}

TEST_F(GeneratedFiles, ParagraphsAreAsLongAsTheTerminal) {
  const auto longest = [&](const std::string& environment) {
    std::istringstream lines(run(environment + "zwidth analyze devices/lhifam.toml --set wall.stiffness=5000").output);
    std::size_t most = 0;
    for (std::string line; std::getline(lines, line) && !line.starts_with("Phase crossovers");) {
      most = std::max(most, line.size());
    }
    return most;
  };
  EXPECT_LE(longest("COLUMNS=60 "), 60U);
  EXPECT_GT(longest("COLUMNS=60 "), 40U);
  EXPECT_LE(longest("COLUMNS=80 "), 80U);
  EXPECT_GT(longest("COLUMNS=80 "), 60U);
  EXPECT_LE(longest("COLUMNS=500 "), 100U);
  EXPECT_GT(longest(""), 100U);  // to a file or a pipe: no line is broken
  EXPECT_GT(longest("COLUMNS=wide "), 100U);
}

}  // namespace
}  // namespace zwidth::cli
