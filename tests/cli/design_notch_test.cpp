#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "cli/workspace.hpp"

namespace zwidth::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// A device that its vibration mode limits.
constexpr const char* mode_limited = R"(name = "Soft cable"
[[body]]
name = "motor"
mass = 0.1
damping = 0.1
[[body]]
name = "handle"
mass = 5.1
damping = 30.0
[[link]]
between = ["motor", "handle"]
stiffness = 20e3
damping = 2.0
[loop]
sampling_period = 1e-3
delay = 1e-3
)";

class DesignNotch : public Workspace {
 protected:
  [[nodiscard]] nlohmann::json answer(const std::string& command) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return nlohmann::json::parse(outcome.output);
  }
};

TEST_F(DesignNotch, WritesADeviceThatAnalyzeConfirms) {
  write("soft.toml", mode_limited);
  const auto design = answer(
      "zwidth design soft.toml --notch --drift-percent 10 --gain-margin-db 0 --phase-margin-deg 0 --lower-any-user "
      "--json --write notched.toml");
  ASSERT_FALSE(design["notch"].is_null());
  const double with = design["stiffness_with"].get<double>();
  EXPECT_GT(with, 1.5 * design["stiffness_without"].get<double>());
  const auto analysis = answer("zwidth analyze notched.toml --json");
  EXPECT_GE(analysis["critical_stiffness"].get<double>(), with);
  EXPECT_EQ(analysis["critical_stiffness"], design["with"]["critical_stiffness"]);
  // The same wall on a cable 10 % off tune: 1.1² of its stiffness, 1.1 of its damping.
  for (const char* drift :
       {"--set link.stiffness=24200 --set link.damping=2.2", "--set link.stiffness=16200 --set link.damping=1.8"}) {
    const auto with_modal_shift = answer(std::string("zwidth analyze notched.toml --json ") + drift);
    EXPECT_GE(with_modal_shift["critical_stiffness"].get<double>(), with * (1.0 - 1e-12));
  }
}

// In time: 2 % below the promised stiffness the notched wall settles, without the notch it grows.
TEST_F(DesignNotch, SimulationAgrees) {
  write("soft.toml", mode_limited);
  const auto design = answer(
      "zwidth design soft.toml --notch --drift-percent 10 --gain-margin-db 0 --phase-margin-deg 0 --lower-any-user "
      "--json --write notched.toml");
  const std::string wall =
      " --set wall.stiffness=" + std::to_string(0.98 * design["stiffness_with"].get<double>()) + " --duration 3 --json";
  EXPECT_EQ(answer("zwidth simulate notched.toml" + wall)["verdict"], "settles");
  EXPECT_EQ(answer("zwidth simulate soft.toml" + wall)["verdict"], "unstable");
}

TEST_F(DesignNotch, SaysWhereNoNotchHelps) {
  const Outcome outcome = run("zwidth design devices/two_mass_drive.toml --notch");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("no notch was found"));
  const Outcome refused = run("zwidth design devices/two_mass_drive.toml --notch --write no.toml");
  EXPECT_EQ(refused.status, 1);
  EXPECT_FALSE(std::filesystem::exists(directory() / "no.toml"));
}

TEST_F(DesignNotch, PrintsATableToPasteAndDraws) {
  write("soft.toml", mode_limited);
  const Outcome outcome =
      run("zwidth design soft.toml --notch --drift-percent 5 --gain-margin-db 6 --phase-margin-deg 0 --lower-any-user "
          "-o notch.svg");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("[[wall.filter]]\n  type = \"notch\""));
  EXPECT_THAT(outcome.output, HasSubstr("What it changes"));
  std::ifstream figure(directory() / "notch.svg");
  EXPECT_THAT((std::string{std::istreambuf_iterator<char>(figure), {}}), HasSubstr("Shift of the modes"));
}

TEST_F(DesignNotch, RefusesWhatItCannotDo) {
  write("plant.toml",
        "[transfer_function]\nnumerator = [1.0]\ndenominator = [1.0, 0.1, 1.0]\n[loop]\nsampling_period = 0.1\n");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"devices/lhifam_rigid.toml --notch", "nothing to be tuned to"},
      {"plant.toml --notch --drift-percent 5", "there is no link"},
      {"devices/lhifam.toml --notch --drift-percent -5", "--drift-percent"},
      {"devices/lhifam.toml --notch --drift-percent 95", "--drift-percent"},
      {"devices/lhifam.toml --notch --gain-margin-db nan", "--gain-margin-db"},
      {"devices/lhifam.toml --notch --goal best", "--goal"},
      {"devices/lhifam.toml --notch -o a.csv", "unknown extension"},
      {"devices/lhifam.toml --notch --write devices/lhifam.toml", "would overwrite"},
      {"devices/lhifam.toml --notch --sweep loop.delay=0:1e-3:3", "excludes"},
      {"devices/lhifam.toml devices/lhifam.toml --notch", "one device file"},
      {"devices/lhifam.toml --drift-percent 5", "add --notch"},
      {"missing.toml --notch", "missing.toml"},
  };
  for (const auto& [arguments, message] : cases) expect_refusal("zwidth design " + arguments, message);
}

}  // namespace
}  // namespace zwidth::cli
