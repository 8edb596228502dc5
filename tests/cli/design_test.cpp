#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class Design : public Workspace {};

// +0.01 % of each number, asked of analyze.
TEST_F(Design, SlopesAreWhatAnalyzeGives) {
  const Outcome outcome = run("zwidth design devices/lhifam.toml --json");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.errors, IsEmpty());
  const auto document = nlohmann::json::parse(outcome.output);
  const double own = document["critical_stiffness"].get<double>();
  int compared = 0;
  for (const auto& each : document["sensitivities"]) {
    if (each["relative"].is_null()) continue;
    ++compared;
    const std::string key = each["parameter"].get<std::string>();
    double moved[2];
    for (const int side : {0, 1}) {
      const double value = each["value"].get<double>() * (side == 0 ? 1.0 - 1e-4 : 1.0 + 1e-4);
      std::string text(32, '\0');
      text.resize(static_cast<std::size_t>(std::snprintf(text.data(), text.size(), "%.17g", value)));
      const Outcome analysis = run("zwidth analyze devices/lhifam.toml --json --set " + key + "=" + text);
      ASSERT_EQ(analysis.status, 0) << analysis.errors;
      moved[side] = nlohmann::json::parse(analysis.output)["critical_stiffness"].get<double>();
    }
    EXPECT_NEAR(each["relative"].get<double>(), (moved[1] - moved[0]) / 2e-4 / own, 1e-6) << key;
  }
  EXPECT_EQ(compared, 7);
}

TEST_F(Design, TakesSeveralFiles) {
  const Outcome text = run("zwidth design devices/lhifam.toml devices/lhifam_rigid.toml");
  ASSERT_EQ(text.status, 0) << text.errors;
  EXPECT_THAT(text.output, HasSubstr("taken as rigid"));
  const Outcome json = run("zwidth design devices/lhifam.toml devices/lhifam_rigid.toml --json");
  EXPECT_EQ(std::count(json.output.begin(), json.output.end(), '\n'), 2);
}

TEST_F(Design, SweepsOneNumberIntoFigureAndTable) {
  const Outcome outcome = run("zwidth design devices/lhifam.toml --sweep loop.delay=0:8e-3:9 -o fig.svg");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(contents("fig.svg"), HasSubstr("crossovers of vibration mode 1"));
  EXPECT_THAT(outcome.output, HasSubstr("loop.delay"));
  ASSERT_EQ(run("zwidth design devices/lhifam.toml --sweep loop.delay=0:8e-3:9 -o all.csv --csv same.csv").status, 0);
  EXPECT_EQ(contents("same.csv"), contents("all.csv"));
  expect_refusal("zwidth design devices/lhifam.toml --target 2x --csv a.csv", "--csv");
  const std::string csv = contents("all.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 10);
}

TEST_F(Design, SweepsTwoNumbers) {
  const Outcome outcome =
      run("zwidth design devices/quanser_torsion.toml --sweep link.stiffness=0.5:2:4:log "
          "--sweep body.load.inertia=1e-4:1e-3:3 --json --any-user -o map.png");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto document = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(document["points"].size(), 12U);
  EXPECT_EQ(document["axes"][1]["parameter"], "body.load.mass");
  EXPECT_FALSE(document["points"][0]["any_user_stiffness"].is_null());
  EXPECT_THAT(contents("map.png"), StartsWith("\x89PNG"));
}

// Lines of equal K_CR in white; the first and the last value are the axis' ends, a tic each.
TEST_F(Design, DrawsTwoNumbersAsContoursBetweenTheirEnds) {
  const std::string command = "zwidth design devices/lhifam.toml --sweep loop.delay=0:4e-3:31 ";
  ASSERT_EQ(run(command + "--sweep link.damping=5:50:5 --figure map.svg").status, 0);
  const std::string drawn = contents("map.svg");
  EXPECT_THAT(drawn, HasSubstr("rgb(255, 255, 255)"));
  for (const char* tic : {">0<", ">4<", ">5<", ">50<"}) EXPECT_THAT(drawn, HasSubstr(tic));
}

TEST_F(Design, ComparesArchitectures) {
  const Outcome outcome =
      run("zwidth design devices/lhifam.toml --compare sensed=motor,handle --operator 0.5,6,135 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto document = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(document["best"]["free"], "motor");
  EXPECT_EQ(document["best"]["any_user"], "handle");
  EXPECT_EQ(document["operator"]["damping"], 6.0);
}

TEST_F(Design, ComparesAnyKeyAndTakesTheFilesOperator) {
  const Outcome outcome =
      run("zwidth design devices/lhifam.toml --set operator.damping=6 --set operator.mass=0.5 "
          "--compare link.stiffness=4e4,8e4,1.6e5 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto document = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(document["designs"].size(), 3U);
  EXPECT_EQ(document["operator"]["mass"], 0.5);
  EXPECT_FALSE(document["designs"][0]["with_operator"].is_null());
}

TEST_F(Design, OfATransferFunctionHasNoUsers) {
  write("plant.toml",
        "[transfer_function]\nnumerator = [1.0]\ndenominator = [1.0, 1.0, 1.0]\n[loop]\nsampling_period = 0.1\n");
  const Outcome outcome = run("zwidth design plant.toml");
  EXPECT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_EQ(run("zwidth design plant.toml --sweep loop.delay=0:0.1:5 -o a.svg").status, 0);
  EXPECT_EQ(run("zwidth design plant.toml --compare loop.delay=0,0.1").status, 0);
  const Outcome refused = run("zwidth design plant.toml --sweep loop.delay=0:0.1:5 --any-user");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.errors, HasSubstr("no body for a user"));
}

// What it says of one number, analyze confirms.
TEST_F(Design, TargetsAreConfirmedByAnalyze) {
  const Outcome outcome = run("zwidth design devices/lhifam.toml --target 12000 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto document = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(document["schema"], "zwidth.design_target/1");
  EXPECT_EQ(document["trust"]["verdict"], "sound");
  const auto& cheapest = document["targets"][0];
  EXPECT_EQ(cheapest["parameter"], "loop.sampling_period");
  const Outcome analysis =
      run("zwidth analyze devices/lhifam.toml --json --set loop.sampling_period=" + cheapest["value_needed"].dump());
  EXPECT_NEAR(nlohmann::json::parse(analysis.output)["critical_stiffness"].get<double>() / 12e3, 1.0, 1e-9);
  const Outcome text = run("zwidth design devices/lhifam.toml --target 12000");
  EXPECT_THAT(text.output, HasSubstr("What reaches it"));
  EXPECT_THAT(text.output, HasSubstr("loop.sampling_period"));
}

TEST_F(Design, ATargetIsAStiffnessOrAMultipleOfTodays) {
  const auto target = [&](const std::string& text) {
    const Outcome outcome = run("zwidth design devices/lhifam_rigid.toml --json --target " + text);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    const auto document = nlohmann::json::parse(outcome.output);
    return document["target"].get<double>() / document["stiffness_now"].get<double>();
  };
  EXPECT_DOUBLE_EQ(target("2x"), 2.0);
  EXPECT_DOUBLE_EQ(target("'200 %'"), 2.0);
  EXPECT_DOUBLE_EQ(target("150%"), 1.5);
  EXPECT_NEAR(target("'14 kN/m'") / target("14000"), 1.0, 1e-12);
}

TEST_F(Design, TargetsAndChangesAreJudgedForAnyUser) {
  const Outcome outcome = run("zwidth design devices/lhifam.toml --target 12000 --json");
  const auto document = nlohmann::json::parse(outcome.output);
  EXPECT_NEAR(document["any_user_now"].get<double>(), 5776.09, 0.01);
  bool lowers_before = false;
  for (const auto& each : document["targets"]) {
    EXPECT_FALSE(each["parameter"].get<std::string>().starts_with("operator."));
    EXPECT_EQ(each["safe"].is_null(), each["value_needed"].is_null()) << each;
    if (each["value_needed"].is_null()) continue;
    EXPECT_EQ(each["safe"], each["any_user_then"] >= document["any_user_now"].get<double>() * (1.0 - 1e-9)) << each;
    EXPECT_FALSE(lowers_before && each["safe"] == true) << each;
    lowers_before = each["safe"] == false;
  }
  const Outcome text = run("zwidth design devices/lhifam.toml --target 12000");
  EXPECT_THAT(text.output, HasSubstr("any passive user then"));
  EXPECT_THAT(text.output, HasSubstr("x 4.72"));  // link.0.damping: +372 %
  EXPECT_THAT(text.output, Not(HasSubstr("372 %")));
}

TEST_F(Design, ADamperAloneIsAGoal) {
  const auto answer = [&](const std::string& options) {
    const Outcome outcome = run("zwidth design devices/lhifam.toml --json " + options);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output);
  };
  const auto target = answer("--goal damper --target 2x");
  EXPECT_EQ(target["goal"], "critical_damping");
  EXPECT_TRUE(target["stiffness_now"].is_null());
  EXPECT_NEAR(target["target"].get<double>() / target["damping_now"].get<double>(), 2.0, 1e-12);
  EXPECT_EQ(answer("--goal damper --target '0.3 kN s/m' --any-user")["goal"], "any_user_damping");
  const auto recommended = answer("--goal damper --recommend");
  EXPECT_EQ(recommended["goal"], "damper");
  EXPECT_EQ(recommended["wall"]["stiffness"], 0.0);
  EXPECT_GE(recommended["margins"]["any_user_critical_damping"].get<double>(),
            1.99 * recommended["wall"]["damping"].get<double>());
  // The file that it writes is judged stable for anyone.
  const Outcome written = run("zwidth design devices/lhifam.toml --recommend --goal damper --write damper.toml");
  ASSERT_EQ(written.status, 0) << written.errors;
  const Outcome judged = run("zwidth analyze damper.toml --json --require-stable");
  EXPECT_EQ(judged.status, 0) << judged.errors;
  EXPECT_THAT(run("zwidth design devices/lhifam.toml --goal damper --target 2x").output, HasSubstr("critical damping"));
}

TEST_F(Design, RefusesWhatItCannotDoBeforeAnyWork) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"devices/lhifam.toml --sweep loop.delay", "has no KEY="},
      {"devices/lhifam.toml --sweep =0:1:3", "has no KEY="},
      {"devices/lhifam.toml --sweep loop.delay=0:1", "has 2 parts"},
      {"devices/lhifam.toml --sweep loop.delay=0:1:3:log:x", "has 5 parts"},
      {"devices/lhifam.toml --sweep loop.delay=a:1:3", "FIRST: \"a\" is no number"},
      {"devices/lhifam.toml --sweep loop.delay=0:inf:3", "LAST: \"inf\" is no number"},
      {"devices/lhifam.toml --sweep loop.delay=0:1e-3:2.5", "COUNT \"2.5\" is no whole number"},
      {"devices/lhifam.toml --sweep loop.delay=0:1e-3:-2", "COUNT \"-2\" is no whole number"},
      {"devices/lhifam.toml --sweep loop.delay=0:1e-3:1", "must be 2 to 1000000"},
      {"devices/lhifam.toml --sweep loop.delay=0:1e-3:1000001", "must be 2 to 1000000"},
      {"devices/lhifam.toml --sweep loop.delay=0:1e-3:5:lin", "is not log"},
      {"devices/lhifam.toml --sweep loop.delay=0:1e-3:5:log", "must be > 0"},
      {"devices/lhifam.toml --sweep loop.delays=0:1e-3:5", "the numbers of this device are"},
      {"devices/lhifam.toml --sweep wall.stiffness=0:1e3:5", "does not change the critical stiffness"},
      {"devices/lhifam.toml --sweep body.motor.mass=0:1:5", "body.motor.mass: is 0"},
      {"devices/lhifam.toml --sweep loop.delay=0:1e-3:5 --sweep loop.delay=0:1e-3:5", "is swept twice"},
      {"devices/lhifam.toml --sweep loop.delay=0:1e-3:5 -o a.bmp", "--output: a.bmp: unknown extension"},
      {"devices/lhifam.toml --sweep loop.delay=0:1e-3:5 -o devices/lhifam.toml", "unknown extension"},
      {"devices/lhifam.toml devices/lhifam_rigid.toml --sweep loop.delay=0:1e-3:5", "takes one device file"},
      {"devices/lhifam.toml -o a.svg", "--output: is for a sweep"},
      {"devices/lhifam.toml --any-user", "--sweep"},
      {"devices/lhifam.toml --operator 1,2,3", "--compare"},
      {"devices/lhifam.toml --target 0", "--target: is 0"},
      {"devices/lhifam.toml --target nan", "--target: is nan"},
      {"devices/lhifam.toml --target 0x", "--target: is 0 times"},
      {"devices/lhifam.toml --target twox", "is no multiple of today's limit"},
      {"devices/lhifam.toml --target '3 kg'", "--target: "},
      {"devices/lhifam.toml --target 1e4 --notch", "excludes"},
      {"devices/lhifam.toml --target 1e4 --goal width", "--goal: width is not for a target"},
      {"devices/lhifam.toml --goal damper", "--goal: is for a notch"},
      {"devices/lhifam.toml --compare sensed", "KEY=VALUE,VALUE"},
      {"devices/lhifam.toml --compare sensed=motor", "has one value"},
      {"devices/lhifam.toml --compare sensed=motor,handel", "handel"},
      {"devices/lhifam.toml --compare sensed=motor,motor", "\"motor\" is given twice"},
      {"devices/lhifam.toml --compare sensed=motor,", "--compare: "},
      {"devices/lhifam.toml --compare sensed=motor,handle --operator=-1,2,3", "operator.mass"},
      {"devices/lhifam.toml --compare sensed=motor,handle --operator 1,2", "--operator"},
      {"devices/lhifam.toml --compare sensed=motor,handle --sweep loop.delay=0:1e-3:5", "--sweep"},
      {"missing.toml", "missing.toml"},
      {"missing.toml --compare sensed=motor,handle", "missing.toml"},
  };
  for (const auto& [arguments, message] : cases) expect_refusal("zwidth design " + arguments, message);
}

}  // namespace
}  // namespace zwidth::cli
