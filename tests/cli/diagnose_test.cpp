#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;

class Diagnose : public Workspace {
 protected:
  [[nodiscard]] nlohmann::json answer(const std::string& command) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output);
  }
};

TEST_F(Diagnose, GivesCauseAndChangesAsJsonAndText) {
  const std::string command = "zwidth diagnose devices/lhifam.toml --oscillates-hz 6.3 --stiffness 9500";
  const auto json = answer(command + " --json");
  EXPECT_EQ(json["schema"], "zwidth.diagnosis/1");
  EXPECT_EQ(json["cause"], "device");
  EXPECT_EQ(json["stiffness"], 9500.0);
  EXPECT_EQ(json["candidates"][0]["limited_by"]["kind"], "rigid_body");
  EXPECT_FALSE(json["changes"].empty());
  const Outcome text = run(command);
  EXPECT_THAT(text.output, HasSubstr("the device itself"));
  EXPECT_THAT(text.output, HasSubstr("What moves it"));
}

TEST_F(Diagnose, DrawsTheFrequencyAmongTheCrossovers) {
  const std::string command = "zwidth diagnose devices/lhifam.toml --oscillates-hz 41 --stiffness 6500 ";
  const Outcome drawn = run(command + "--figure loop.svg");
  ASSERT_EQ(drawn.status, 0) << drawn.errors;
  EXPECT_EQ(drawn.output, run(command).output);
  for (const char* part : {"41 Hz", "6.5 kN/m", "6.143 Hz"}) EXPECT_THAT(contents("loop.svg"), HasSubstr(part));
}

// A simulated run, recorded, tells frequency and amplitude.
TEST_F(Diagnose, ReadsTheFrequencyFromARecording) {
  const Outcome simulated =
      run("zwidth simulate devices/lhifam.toml --set wall.stiffness=9200 --duration 4 --csv run.csv");
  ASSERT_EQ(simulated.status, 0) << simulated.errors;
  const Outcome columns = run("zwidth diagnose devices/lhifam.toml --recording run.csv --list");
  ASSERT_EQ(columns.status, 0) << columns.errors;
  const auto json =
      answer("zwidth diagnose devices/lhifam.toml --recording run.csv --position measured --stiffness 9200 --json");
  EXPECT_EQ(run("sed 1s/measured/position_m/ run.csv > called.csv").status, 0);
  EXPECT_EQ(
      answer("zwidth diagnose devices/lhifam.toml --recording called.csv --stiffness 9200 --json")["oscillates_hz"],
      json["oscillates_hz"]);
  EXPECT_EQ(json["cause"], "device");
  EXPECT_NEAR(json["oscillates_hz"].get<double>(), 6.25, 0.15);
  EXPECT_GT(json["amplitude"].get<double>(), 1e-4);
}

// A damper alone: --stiffness 0 was refused, and a user's grasp was blamed.
TEST_F(Diagnose, OfADamperAlone) {
  write("wheel.toml",
        "name = \"wheel\"\nmotion = \"rotary\"\n[[body]]\nname = \"rotor\"\ninertia = 2e-6\ndamping = 2e-5\n"
        "[loop]\nsampling_period = 1e-3\ndelay = 1e-3\n");
  const std::string command = "zwidth diagnose wheel.toml --oscillates-hz 165.1 --stiffness 0 --damping 0.006";
  const auto json = answer(command + " --json");
  EXPECT_EQ(json["cause"], "device");
  EXPECT_EQ(json["nearest"], "device");
  EXPECT_EQ(json["limit_of"], "damping");
  EXPECT_EQ(json["stiffness"], 0.0);
  EXPECT_TRUE(json["candidates"][0]["stiffness"].is_null());
  const double limit = json["candidates"][0]["damping"].get<double>();
  EXPECT_GT(limit, 0.0);
  EXPECT_LT(limit, 0.006);
  const auto& weaker = json["changes"].back();
  EXPECT_EQ(weaker["limit_now"], limit);
  for (const auto& each : json["changes"]) EXPECT_TRUE(each["safe"].is_boolean()) << each;
  const Outcome text = run(command);
  EXPECT_THAT(text.output, HasSubstr("limit of B"));
}

// The limit with any user is 14 % away: the nearest is named, with what would have to be otherwise.
TEST_F(Diagnose, TheNearestWhereNoneFits) {
  const std::string command = "zwidth diagnose devices/lhifam.toml --oscillates-hz 41.36 --stiffness 5000";
  const auto json = answer(command + " --json");
  EXPECT_TRUE(json["cause"].is_null());
  EXPECT_EQ(json["nearest"], "passive_user");
  EXPECT_EQ(json["trust"]["verdict"], "doubtful");
  EXPECT_NEAR(json["candidates"][0]["otherwise"]["limit"].get<double>(), 5000.0 / 5776.09, 1e-4);
  EXPECT_FALSE(json["changes"].empty());
  const Outcome text = run(command);
  EXPECT_THAT(text.output, HasSubstr("13 % lower, 5 kN/m"));
}

TEST_F(Diagnose, RefusesWhatItCannotMean) {
  expect_refusal("zwidth diagnose devices/lhifam.toml", "--oscillates-hz: missing; give the frequency");
  for (const std::string option : {"--stiffness", "--damping", "--amplitude"}) {
    expect_refusal("zwidth diagnose devices/lhifam.toml --oscillates-hz 6 " + option + " 1e40",
                   option + ": devices/lhifam.toml: is 1e+40; must be from 1e-30 to 1e+30");
  }
  expect_refusal("zwidth diagnose devices/lhifam.toml --oscillates-hz 600",
                 "--oscillates-hz: devices/lhifam.toml: is 600");
  expect_refusal("zwidth diagnose devices/lhifam.toml --oscillates-hz 6 --position 2",
                 "--position: is about a recording");
  expect_refusal("zwidth diagnose devices/lhifam.toml --oscillates-hz 6 --stiffness -1",
                 "--stiffness: devices/lhifam.toml");
}

}  // namespace
}  // namespace zwidth::cli
