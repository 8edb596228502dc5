#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/workspace.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* example =
    "zwidth identify recordings/free_motion.csv --force force --position position --method inverse-dynamics ";

using IdentifyRigidBody = Workspace;

TEST_F(IdentifyRigidBody, FindsTheExampleRecordingsBody) {
  const Outcome outcome = run(std::string(example) + "--json --output-device body.toml");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto document = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(document.at("schema"), "zwidth.inverse_dynamics/1");
  // As scripts/example_motion_recording moved it; a held force acts half of 2 ms late.
  const std::map<std::string, double> truth{
      {"mass", 5.4}, {"viscous", 3.5}, {"coulomb", 1.2}, {"offset", 0.3}, {"delay", 1e-3}};
  const std::map<std::string, std::string> units{
      {"mass", "kg"}, {"viscous", "N s/m"}, {"coulomb", "N"}, {"offset", "N"}, {"delay", "s"}};
  ASSERT_EQ(document.at("parameters").size(), truth.size());
  for (const auto& parameter : document.at("parameters")) {
    const std::string key = parameter.at("key");
    EXPECT_NEAR(parameter.at("value").get<double>(), truth.at(key), 0.01 * truth.at(key)) << key;
    EXPECT_EQ(parameter.at("unit"), units.at(key));
    EXPECT_LT(parameter.at("interval").at(0), parameter.at("value"));
    EXPECT_GT(parameter.at("interval").at(1), parameter.at("value"));
  }
  const auto device = read_device_file((directory() / "body.toml").string());
  ASSERT_TRUE(device) << device.error().str();
  const Body& body = device->bodies().front();
  EXPECT_NEAR(body.mass, 5.4, 0.01);
  EXPECT_NEAR(body.damping, 3.5, 0.04);
  EXPECT_NEAR(body.coulomb, 1.2, 0.02);
  EXPECT_DOUBLE_EQ(device->loop().sampling_period, 2e-3);
  ASSERT_TRUE(device->parameters().uncertainty);
  EXPECT_EQ(device->parameters().uncertainty->parameters.size(), 4U);  // the delay is the fourth
  const auto analysis = nlohmann::json::parse(run("zwidth analyze body.toml --json").output);
  // 2 b / T for a light damper, with its interval.
  EXPECT_NEAR(analysis.at("critical_stiffness").get<double>(), 3500.0, 50.0);
  EXPECT_TRUE(analysis.at("critical_stiffness_interval").is_array());
}

TEST_F(IdentifyRigidBody, TellsItInWords) {
  const Outcome outcome = run(example);
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.output, AllOf(StartsWith("A rigid body, identified from recordings/free_motion.csv\n"),
                                    HasSubstr("N s/m"), HasSubstr("95 % from"), HasSubstr("--output-device")));
  const Outcome rotary = run(std::string(example) + "--motion rotary");
  EXPECT_THAT(rotary.output, AllOf(HasSubstr("kg m²"), HasSubstr("N m s/rad")));
  const Outcome piped = run(std::string(example) + "--output-device - | zwidth analyze -");
  EXPECT_THAT(piped.output, HasSubstr("critical stiffness"));
}

TEST_F(IdentifyRigidBody, DrawsForceModelAndResidual) {
  ASSERT_EQ(run(std::string(example) + "--figure force.svg --csv force.csv").status, 0);
  EXPECT_THAT(contents("force.csv"), ::testing::StartsWith("time_s,force,fitted_force,trust\n"));
  const std::string figure = contents("force.svg");
  EXPECT_THAT(figure, AllOf(HasSubstr("free_motion.csv: zoom on"), HasSubstr("Residual (mN)"), HasSubstr("Force (N)"),
                            HasSubstr("low-pass of")));
}

TEST_F(IdentifyRigidBody, Refusals) {
  const std::string rigid = example;
  expect_refusal(rigid + "--window hann", "--window: is not for");
  expect_refusal(rigid + "--free link.stiffness", "--free: is not for");
  expect_refusal(rigid + "--cutoff-hz 300", "--cutoff-hz: recordings/free_motion.csv: cutoff is 300 Hz");
  expect_refusal(rigid + "--sampling-period 1e40", "--sampling-period: is 1e+40 s; must be from 1e-30 to 1e+30");
  expect_refusal(rigid + "--decimation 0", "decimation");
  expect_refusal(rigid + "--force-scale -1", "opposite signs");
  expect_refusal(rigid + "--sampling-period 0", "--sampling-period: is 0");
  expect_refusal(
      "zwidth identify recordings/free_motion.csv --force force --velocity position --method "
      "inverse-dynamics",
      "--velocity: is not for");
  expect_refusal(
      "zwidth identify recordings/free_motion.csv --force force --position position --cutoff-hz 5 "
      "--structure rigid",
      "--cutoff-hz: is for --method inverse-dynamics");
  expect_refusal("zwidth identify recordings/free_motion.csv --force force --position position",
                 "--structure: missing");
  expect_refusal(
      "awk -F, 'NR==1 || $1 < 0.1' recordings/free_motion.csv > short.csv; zwidth identify short.csv "
      "--force force --position position --method inverse-dynamics",
      "at least 100");
}

TEST_F(IdentifyRigidBody, ReproducesThePublishedBench) {
  const std::string recording = std::string(ZWIDTH_SHARED_DIR) + "/data/emps/DATA_EMPS.mat";
  if (!std::filesystem::exists(recording)) GTEST_SKIP() << "no recordings beside the project";
  const Outcome outcome = run("zwidth identify " + recording +
                              " --method inverse-dynamics --force vir --force-scale 35.15 --position qm --time t "
                              "--json");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  // Janot, Gautier, Brunot 2019.
  const std::map<std::string, double> published{
      {"mass", 95.1089}, {"viscous", 203.5034}, {"coulomb", 20.3935}, {"offset", -3.1648}};
  for (const auto& parameter : nlohmann::json::parse(outcome.output).at("parameters")) {
    const auto known = published.find(parameter.at("key"));
    if (known == published.end()) continue;
    EXPECT_NEAR(parameter.at("value").get<double>(), known->second, 0.01 * std::abs(known->second)) << known->first;
    EXPECT_LE(parameter.at("interval").at(0), known->second) << known->first;
    EXPECT_GE(parameter.at("interval").at(1), known->second) << known->first;
  }
}

}  // namespace
}  // namespace zwidth::cli
