// zwidth analyze on real input. Numbers: theory notes, section 2 (100-digit arithmetic), to 1e-9 relative.

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

class Analyze : public Workspace {
 protected:
  /// The documents that `command_line` prints, one per line.
  [[nodiscard]] std::vector<json> documents(const std::string& command_line) const {
    const Outcome outcome = run(command_line);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_THAT(outcome.errors, IsEmpty());
    std::vector<json> parsed;
    std::istringstream lines(outcome.output);
    for (std::string line; std::getline(lines, line);) parsed.push_back(json::parse(line));
    return parsed;
  }
};

void expect_relative(const json& value, double expected) {
  ASSERT_TRUE(value.is_number());
  EXPECT_NEAR(value.get<double>() / expected, 1.0, 1e-9);
}

// The answer to a device whose numbers nothing carries is "refused", which is an answer: exit status 0, and no number.
TEST_F(Analyze, ARefusedDeviceHasNoNumber) {
  const std::string refused = contents("devices/lhifam.toml") +
                              "\n[uncertainty]\nverdict = \"refused\"\nwarning = \"the record excites nothing; excite "
                              "up to 40 Hz\"\n";
  write("refused.toml", refused);
  const auto all = documents("zwidth analyze refused.toml --set wall.stiffness=100 --json");
  ASSERT_EQ(all.size(), 1U);
  const json& document = all.front();
  EXPECT_EQ(document["trust"]["verdict"], "refused");
  EXPECT_THAT(document["trust"]["reasons"][0].get<std::string>(), HasSubstr("excite up to 40 Hz"));
  EXPECT_EQ(document["status"], "refused");
  for (const char* key : {"critical_stiffness", "critical_stiffness_db", "critical_frequency_rad_s", "limited_by",
                          "any_user", "wall", "critical_stiffness_interval"}) {
    EXPECT_TRUE(document[key].is_null()) << key;
  }
  EXPECT_TRUE(document["rigid_approximation"]["critical_stiffness"].is_null());
  EXPECT_THAT(document["crossovers"], IsEmpty());
  const Outcome text = run("zwidth analyze refused.toml");
  EXPECT_EQ(text.status, 0);
  EXPECT_THAT(text.output.substr(0, 300), HasSubstr("REFUSED, no number is given: the record excites nothing"));
  EXPECT_THAT(text.output, ::testing::Not(HasSubstr("kN/m")));
}

TEST_F(Analyze, RequireStableFailsWhereTheWallIsNotStableOrTheAnswerNotSound) {
  const std::string stable = "zwidth analyze devices/lhifam.toml --set wall.stiffness=5000 --require-stable";
  EXPECT_EQ(run(stable).status, 0);
  const Outcome unstable = run("zwidth analyze devices/lhifam.toml --set wall.stiffness=9000 --require-stable");
  EXPECT_EQ(unstable.status, 1);
  EXPECT_THAT(unstable.errors, HasSubstr("devices/lhifam.toml: the wall is unstable with nobody holding"));
  EXPECT_THAT(unstable.output, HasSubstr("is unstable: "));
  const Outcome doubtful = run(stable + " --set 'uncertainty.warning=\"misfit\"'");
  EXPECT_EQ(doubtful.status, 1) << doubtful.output;
  EXPECT_THAT(doubtful.errors, HasSubstr("DOUBTFUL: misfit"));
  EXPECT_EQ(run("zwidth analyze devices/lhifam.toml --require-stable").status, 2);
}

TEST_F(Analyze, LhifamHasItsPublishedAnswer) {
  const auto all = documents("zwidth analyze devices/lhifam.toml --json");
  ASSERT_EQ(all.size(), 1U);
  const json& document = all.front();
  EXPECT_EQ(document["status"], "finite");
  expect_relative(document["critical_stiffness"], 8848.70869499712);
  expect_relative(document["critical_frequency_rad_s"], 38.5965268731856);
  EXPECT_NEAR(document["critical_stiffness_db"].get<double>(), 78.93759796, 1e-7);
  EXPECT_EQ(document["limited_by"], (json{{"kind", "rigid_body"}}));
  const std::vector<double> stiffnesses = {8848.70869499712, 140372.949098511, 33895.4748192464, 135171032.89};
  ASSERT_EQ(document["crossovers"].size(), stiffnesses.size());
  for (std::size_t i = 0; i < stiffnesses.size(); ++i) {
    // The last is printed with 11 digits.
    EXPECT_NEAR(document["crossovers"][i]["stiffness"].get<double>() / stiffnesses[i], 1.0, 1e-9) << i;
  }
  expect_relative(document["rigid_approximation"]["critical_stiffness"], 7000.75625452837);
  EXPECT_NEAR(document["q_criterion"]["db"].get<double>(), 78.5565, 5e-4);
  EXPECT_EQ(document["q_criterion"]["mode_matters"], false);
  EXPECT_TRUE(document["wall"].is_null());
}

TEST_F(Analyze, OverridesReachTheLoop) {
  const std::vector<std::pair<std::string, double>> cases = {
      {"--set loop.sensed=handle", 6938.97435107544},
      {"--set loop.delay=0.25e-3", 5342.97877445573},
      {"--set loop.delay=0.25e-3 --set loop.sensed=handle", 4641.4956115197},
      {"--set link.stiffness=27.55e3 --set link.0.damping=10.5 --set loop.sensed=\"'handle'\"", 6790.5752652799},
  };
  for (const auto& [overrides, expected] : cases) {
    const auto all = documents("zwidth analyze " + overrides + " devices/lhifam.toml --json");
    ASSERT_EQ(all.size(), 1U) << overrides;
    expect_relative(all.front()["critical_stiffness"], expected);
  }
}

TEST_F(Analyze, JudgesTheWallOnBothSidesOfTheLimit) {
  const auto stable = documents("zwidth analyze devices/lhifam.toml --json --set wall.stiffness=8848");
  EXPECT_EQ(stable.front()["wall"]["stable"], true);
  EXPECT_LT(stable.front()["wall"]["spectral_radius"].get<double>(), 1.0);
  EXPECT_NEAR(stable.front()["wall"]["gain_margin_db"].get<double>(), 20 * std::log10(8848.70869499712 / 8848), 1e-6);
  const auto unstable = documents("zwidth analyze devices/lhifam.toml --json --set wall.stiffness=8850");
  EXPECT_EQ(unstable.front()["wall"]["stable"], false);
  EXPECT_GT(unstable.front()["wall"]["spectral_radius"].get<double>(), 1.0);
  EXPECT_TRUE(unstable.front()["wall"]["delay_margin_s"].is_null());
}

TEST_F(Analyze, TextLeadsWithTheAnswer) {
  const Outcome outcome = run("zwidth analyze devices/lhifam.toml");
  EXPECT_EQ(outcome.status, 0);
  std::istringstream lines(outcome.output);
  std::vector<std::string> first(5);
  for (std::string& line : first) std::getline(lines, line);
  EXPECT_EQ(first[0], "LHIfAM, translational axis" + std::string(61, ' ') + "sound");
  EXPECT_THAT(first[1],
              StartsWith("  spring alone    nobody holding     8.849 kN/m, then shakes at 6.143 Hz: the rigid "
                         "body and the sampling delay of T/2 = 500 "));
  EXPECT_EQ(first[2], "                  any passive user   5.776 kN/m, worst at 41.36 Hz");
  EXPECT_THAT(first[3], StartsWith("  with a damper   any passive user   up to 187."));
  EXPECT_THAT(first[4], AllOf(StartsWith("  with margins    any passive user   25.19 kN/m, B = 238.5 N s/m"),
                              ::testing::EndsWith("       zwidth design FILE --recommend")));
}

TEST_F(Analyze, WallsAreThoseOfTheRegionAndTheRecommendation) {
  EXPECT_TRUE(documents("zwidth analyze devices/lhifam.toml --json").front()["walls"].is_null());
  const json walls = documents("zwidth analyze devices/lhifam.toml --json --walls").front()["walls"];
  const json stiffest = documents("zwidth region devices/lhifam.toml --json").front()["any_user"]["stiffest"];
  EXPECT_NEAR(walls["with_damper"]["stiffness"].get<double>() / stiffest["stiffness"].get<double>(), 1.0, 2e-3);
  const json run = documents("zwidth design devices/lhifam.toml --recommend --json").front();
  EXPECT_EQ(walls["with_margins"]["stiffness"], run["wall"]["stiffness"]);
  EXPECT_EQ(walls["with_margins"]["damping"], run["wall"]["damping"]);
  EXPECT_EQ(walls["with_margins"]["velocity_filter_hz"], run["wall"]["velocity_filter_hz"]);
}

// A person lets go: the knob was called stable, exit status 0, with a tenth of the limit left.
TEST_F(Analyze, RequireStableJudgesNobodyAndTheFilesUser) {
  const std::string knob =
      "motion = \"rotary\"\n[[body]]\nname = \"knob\"\ninertia = 2e-3\ndamping = 7.1e-3\n[loop]\nsampling_period = "
      "1e-3\n[operator]\ndamping = 6.5e-2\n[wall]\nstiffness = ";
  write("knob.toml", knob + "40\n");
  const Outcome shakes = run("zwidth analyze knob.toml --require-stable --json");
  EXPECT_EQ(shakes.status, 1);
  EXPECT_THAT(shakes.errors, HasSubstr("knob.toml: the wall is unstable with nobody holding"));
  const json document = json::parse(shakes.output);
  EXPECT_EQ(document["wall"]["stable"], false);
  EXPECT_EQ(document["wall"]["stable_for"], (json{{"nobody", false}, {"user", true}, {"any_user", false}}));
  EXPECT_NEAR(document["limits"]["nobody"]["critical_stiffness"].get<double>(), 14.2, 0.05);
  EXPECT_EQ(document["limits"]["user"]["critical_stiffness"], document["critical_stiffness"]);
  write("soft.toml", knob + "10\n");
  EXPECT_EQ(run("zwidth analyze soft.toml --require-stable").status, 0);
}

// Nothing returns a damped wheel to a place: that is no instability.
TEST_F(Analyze, RequireStableOfADamperAlone) {
  const std::string wheel = "motion = \"rotary\"\n[[body]]\nname = \"wheel\"\n";
  write("wheel.toml", wheel +
                          "inertia = 0.05\ndamping = 0.01\n[loop]\nsampling_period = 1e-3\n"
                          "[wall]\nstiffness = 0\ndamping = 0.5\n");
  EXPECT_EQ(run("zwidth analyze wheel.toml --require-stable").status, 0);
  write("rotor.toml", wheel +
                          "inertia = 2e-6\ndamping = 2e-5\n[loop]\nsampling_period = 1e-3\ndelay = 1e-3\n"
                          "[wall]\nstiffness = 0\ndamping = 0.006\n");
  const Outcome rotor = run("zwidth analyze rotor.toml --require-stable --json");
  EXPECT_EQ(rotor.status, 1);
  const json document = json::parse(rotor.output);
  EXPECT_NEAR(document["wall"]["spectral_radius"].get<double>(), 1.569, 5e-4);
  EXPECT_LT(document["limits"]["nobody"]["critical_damping"].get<double>(), 0.006);
}

TEST_F(Analyze, ReadsStandardInput) {
  const auto all = documents("zwidth analyze - --json < devices/lhifam.toml");
  ASSERT_EQ(all.size(), 1U);
  expect_relative(all.front()["critical_stiffness"], 8848.70869499712);
  EXPECT_EQ(documents("cat devices/lhifam.toml | zwidth analyze --json devices/lhifam.toml -").size(), 2U);
}

TEST_F(Analyze, SeveralDevicesAreOneLineEachInOrder) {
  const auto all = documents("zwidth analyze --json devices/lhifam.toml devices/lhifam_rigid.toml");
  ASSERT_EQ(all.size(), 2U);
  expect_relative(all[0]["critical_stiffness"], 8848.70869499712);
  expect_relative(all[1]["critical_stiffness"], 7000.75625452837);
  EXPECT_TRUE(all[1]["q_criterion"].is_null());
}

TEST_F(Analyze, SeveralDevicesAsTextLeadWithATable) {
  const Outcome outcome = run("zwidth analyze devices/*.toml");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, StartsWith("     device "));
}

TEST_F(Analyze, NamesTheWorstUserOnRequest) {
  const auto document = documents("zwidth analyze devices/lhifam_handle_sensed.toml --worst-user --json").front();
  const json& any_user = document["any_user"];
  const json& worst = any_user["worst_user"];
  EXPECT_LT(any_user["truncation"].get<double>(), 1e-7);
  EXPECT_EQ(worst["damping"], 0.0);
  EXPECT_EQ(worst["absorbers"].size(), 2U);
  const double ratio = worst["critical_stiffness"].get<double>() / any_user["critical_stiffness"].get<double>();
  EXPECT_GE(ratio, 1.0);
  EXPECT_LE(ratio, 1.0001);
  EXPECT_THAT(run("zwidth analyze devices/lhifam.toml --worst-user").output,
              HasSubstr("\n  the worst one       a spring of 362.3 kN/m: 5.776 kN/m, 0.0002"));
  EXPECT_TRUE(documents("zwidth analyze devices/lhifam.toml --json").front()["any_user"]["worst_user"].is_null());
}

TEST_F(Analyze, SearchesAFamilyOfUsers) {
  const std::string users = " --users mass=0:2,damping=0:30,stiffness=0:1000";
  const auto document = documents("zwidth analyze devices/lhifam.toml --json" + users).front();
  const json& family = document["user_family"];
  EXPECT_EQ(family["mass"], (json{0.0, 2.0}));
  expect_relative(family["free_critical_stiffness"], 8848.70869499712);
  EXPECT_EQ(family["worst_user"], (json{{"mass", 0.0}, {"damping", 0.0}, {"stiffness", 1000.0}}));
  // The same user as [operator].
  const auto held = documents("zwidth analyze devices/lhifam.toml --json --set operator.stiffness=1000").front();
  EXPECT_EQ(family["critical_stiffness"], held["critical_stiffness"]);
  EXPECT_THAT(run("zwidth analyze devices/lhifam.toml" + users).output,
              AllOf(HasSubstr("\n  users as given      8.829 kN/m, least found, with mass 0 kg, damping 0 N s/m"),
                    HasSubstr("asked for: mass 0 to 2 kg")));
}

TEST_F(Analyze, AFamilyKeepsTheOperatorsOwnValues) {
  const auto document =
      documents("zwidth analyze devices/lhifam.toml --json --set operator.damping=4 --users mass=0.5,stiffness=1:2")
          .front();
  EXPECT_EQ(document["user_family"]["damping"], (json{4.0, 4.0}));
  EXPECT_EQ(document["user_family"]["mass"], (json{0.5, 0.5}));
}

TEST_F(Analyze, RefusesImpossibleUsers) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"mass=-1:2", "--users: devices/lhifam.toml: mass: is from -1 to 2; must be finite, >= 0 and not reversed"},
      {"mass=2:1", "mass: is from 2 to 1"},
      {"mas=0:1", "there is no key 'mas'; did you mean mass?"},
      {"colour=0:1", "there is no key 'colour'; one of mass, damping, stiffness"},
      {"mass=0:1:2", "must be LEAST:GREATEST or one number"},
      {"mass=", "must be LEAST:GREATEST or one number"},
      {"mass=0:inf", "must be LEAST:GREATEST or one number"},
      {"mass=nan", "must be LEAST:GREATEST or one number"},
      {"mass=0:1,mass=1:2", "mass is given twice"},
      {"mass", "'mass' must be KEY=LEAST:GREATEST"},
      {"mass=0:1,", "'' must be KEY=LEAST:GREATEST"},
      {"''", "--users: is empty"},
  };
  for (const auto& [users, message] : cases) {
    expect_refusal("zwidth analyze devices/lhifam.toml --users " + users, message);
  }
  write("lag.toml", "[transfer_function]\nnumerator = [1]\ndenominator = [1, 1]\n[loop]\nsampling_period = 1.0\n");
  for (const std::string option : {"--worst-user", "--users mass=0:1"}) {
    expect_refusal("zwidth analyze lag.toml " + option, "lag.toml: is a transfer function; it has no body to hold");
  }
}

TEST_F(Analyze, TooManyBodiesForTheWorstUserAreRefusedAtOnce) {
  std::string chain = "[loop]\nsampling_period = 1e-3\nactuated = \"0\"\nsensed = \"0\"\nheld = \"0\"\n";
  for (int i = 0; i < 100; ++i) {
    chain += fmt::format("[[body]]\nname = \"{}\"\nmass = 0.1\ndamping = 0.1\n", i);
    if (i > 0) {
      chain += fmt::format("[[link]]\nbetween = [\"{}\", \"{}\"]\nstiffness = 1e4\ndamping = 1\n", i - 1, i);
    }
  }
  write("chain.toml", chain);
  expect_refusal("timeout 2 zwidth analyze chain.toml --users mass=0:1 --worst-user",
                 "--worst-user: chain.toml: has 100 bodies; at most 20");
}

TEST_F(Analyze, ATransferFunctionHasNoBodies) {
  write("lag.toml", "[transfer_function]\nnumerator = [1]\ndenominator = [1, 1]\n[loop]\nsampling_period = 1.0\n");
  const json document = documents("zwidth analyze lag.toml --json").front();
  EXPECT_EQ(document["device"], "lag");
  EXPECT_NEAR(document["critical_stiffness"].get<double>(), 2.16395, 5e-6);  // theory notes, section 6
  EXPECT_TRUE(document["rigid_approximation"].is_null());
  EXPECT_TRUE(document["q_criterion"].is_null());
  EXPECT_EQ(run("zwidth analyze lag.toml").status, 0);
}

TEST_F(Analyze, RotaryDevicesHaveRotaryUnits) {
  write("paddle.toml",
        "motion = \"rotary\"\n[[body]]\nname = \"arm\"\ninertia = 5e-4\ndamping = 1e-3\n[loop]\nsampling_period = "
        "1e-3\n");
  const json document = documents("zwidth analyze paddle.toml --json").front();
  EXPECT_EQ(document["units"], (json{{"stiffness", "N m/rad"}, {"damping", "N m s/rad"}}));
  EXPECT_THAT(run("zwidth analyze paddle.toml").output,
              AllOf(HasSubstr(" N m/rad, then shakes at "), HasSubstr("damper alone ")));
}

TEST_F(Analyze, AnUndampedDeviceHasNoStableWall) {
  write("free.toml", "[[body]]\nname = \"mass\"\nmass = 1.0\n[loop]\nsampling_period = 1e-3\n");
  const json document = documents("zwidth analyze free.toml --json").front();
  EXPECT_EQ(document["status"], "none_stable");
  EXPECT_EQ(document["critical_stiffness"], 0.0);
  EXPECT_TRUE(document["limited_by"].is_null());
  EXPECT_THAT(run("zwidth analyze free.toml").output, HasSubstr("none: no wall is stable, however soft"));
}

TEST_F(Analyze, TheReportIsOneFileAndTheAnswerIsStillPrinted) {
  const Outcome outcome = run("zwidth analyze devices/lhifam.toml --report report.html");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("8.849 kN/m"));
  EXPECT_THAT(run("cat report.html").output, HasSubstr("8.849"));
  EXPECT_EQ(documents("zwidth analyze devices/lhifam.toml --json --report again.html").size(), 1U);
}

TEST_F(Analyze, AReportThatCannotBeWrittenFailsAndLeavesNothing) {
  for (const std::string target : {"missing/report.html", "devices", "/dev/full"}) {
    const Outcome outcome = run("zwidth analyze devices/lhifam.toml --report " + target);
    EXPECT_EQ(outcome.status, 1) << target;
    EXPECT_THAT(outcome.errors, StartsWith("zwidth: ")) << target;
    EXPECT_EQ(std::count(outcome.errors.begin(), outcome.errors.end(), '\n'), 1) << outcome.errors;
  }
  EXPECT_EQ(run("ls").output, "devices\nrecordings\n");
}

}  // namespace
}  // namespace zwidth::cli
