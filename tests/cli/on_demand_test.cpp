// What the program loads at the first call, where it is missing.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/workspace.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::cli {
namespace {

class LoadedOnDemand : public Workspace {
 protected:
  /// With the program's file alone.
  [[nodiscard]] Outcome run_alone(const std::string& command) const {
    return run("mkdir -p alone/bin && cp \"$(command -v zwidth)\" alone/bin && PATH=$PWD/alone/bin:$PATH && " +
               command);
  }
};

TEST_F(LoadedOnDemand, AFitThatCannotBeLoadedIsAnErrorAndOtherAnswersStay) {
  const Outcome answered = run_alone("zwidth analyze devices/lhifam.toml --json");
  EXPECT_EQ(answered.status, 0) << answered.errors;
  const Outcome refused = run_alone(
      "zwidth identify recordings/locked_chirp.csv --force force --position position "
      "--structure two-body --locked handle --json");
  EXPECT_EQ(refused.status, 1) << refused.output;
  EXPECT_EQ(refused.output, "");
  EXPECT_THAT(refused.errors, ::testing::HasSubstr("fits-"));
}

// Three poles at -10 rad/s, one at -10.000001 rad/s.
TEST_F(LoadedOnDemand, PolesThatCrowdAreFoundAsTheLibraryFindsThem) {
  write("crowded.toml",
        "motion = \"linear\"\n"
        "[transfer_function]\n"
        "numerator = [1.0]\n"
        "denominator = [1.0, 40.000001, 600.00003, 4000.0003, 10000.001, 0.0]\n"
        "[loop]\n"
        "sampling_period = 1e-3\n");
  const auto device = read_device_file((directory() / "crowded.toml").string());
  ASSERT_TRUE(device);
  const Outcome answered = run("zwidth analyze crowded.toml --json");
  ASSERT_EQ(answered.status, 0) << answered.errors;
  EXPECT_EQ(nlohmann::json::parse(answered.output).at("critical_stiffness"),
            analyze(*device).limits.nobody.critical_stiffness);
  const Outcome refused = run_alone("zwidth analyze crowded.toml --json");
  EXPECT_EQ(refused.status, 1) << refused.output;
  EXPECT_EQ(refused.output, "");
  EXPECT_THAT(refused.errors, ::testing::HasSubstr("digits-"));
}

#ifdef ZWIDTH_MUJOCO
TEST_F(LoadedOnDemand, AMechanismIsAnsweredAsTheLibraryAnswersIt) {
  const std::string file = "devices/mechanisms/planar_arm.toml";
  const auto device = read_device_file((directory() / file).string());
  ASSERT_TRUE(device) << device.error().str();
  const Outcome answered = run("zwidth analyze " + file + " --json");
  ASSERT_EQ(answered.status, 0) << answered.errors;
  const auto document = nlohmann::json::parse(answered.output);
  EXPECT_EQ(document.at("critical_stiffness"), analyze(*device).limits.nobody.critical_stiffness);
  const Outcome refused = run_alone("zwidth analyze " + file + " --json");
  EXPECT_EQ(refused.status, 1) << refused.output;
  EXPECT_THAT(refused.errors, ::testing::HasSubstr("mechanisms-"));
}
#endif

}  // namespace
}  // namespace zwidth::cli
