#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

#include "cli/workspace.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth::cli {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string example =
    "zwidth identify recordings/free_motion.csv --force force --position position --method time-domain ";

using IdentifyInTime = Workspace;

// As scripts/example_motion_recording moved it: 5.4 kg, 3.5 N s/m, 1.2 N of friction, a load of 0.3 N; T = 2 ms.
TEST_F(IdentifyInTime, FindsTheExampleRecordingsBody) {
  const Outcome outcome = run(example + "--structure rigid --json --output-device body.toml");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  const auto document = nlohmann::json::parse(outcome.output);
  EXPECT_EQ(document.at("schema"), "zwidth.identification/1");
  EXPECT_EQ(document.at("method"), "time-domain");
  EXPECT_EQ(document.at("trust").at("verdict"), "doubtful");  // a position controller moved it
  EXPECT_THAT(document.at("trust").at("reasons").at(0).get<std::string>(), HasSubstr("recorded in feedback"));
  EXPECT_NEAR(document.at("critical_stiffness").get<double>(), 3500.0, 35.0);
  EXPECT_LT(document.at("critical_stiffness_interval").at(0).get<double>(), 3500.0);
  EXPECT_GT(document.at("critical_stiffness_interval").at(1).get<double>(), 3500.0);
  ASSERT_EQ(document.at("recordings").size(), 1U);
  EXPECT_NEAR(document.at("recordings").at(0).at("constant_force").get<double>(), -0.3, 0.02);
  const auto device = read_device_file((directory() / "body.toml").string());
  ASSERT_TRUE(device) << device.error().str();
  EXPECT_NEAR(device->bodies().front().mass, 5.4, 0.01);
  EXPECT_NEAR(device->bodies().front().coulomb, 1.2, 0.02);
  ASSERT_TRUE(device->parameters().uncertainty);
  const auto analysis = nlohmann::json::parse(run("zwidth analyze body.toml --json").output);
  EXPECT_EQ(analysis.at("critical_stiffness"), document.at("critical_stiffness"));
  EXPECT_EQ(analysis.at("critical_stiffness_interval"), document.at("critical_stiffness_interval"));
}

TEST_F(IdentifyInTime, TakesSeveralRecordingsAndTellsItInWords) {
  const Outcome outcome =
      run("zwidth identify recordings/free_motion.csv recordings/free_motion.csv --force force --position position "
          "--method time-domain --structure rigid --explain");
  ASSERT_EQ(outcome.status, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("identified in time from recordings/free_motion.csv and 1 more"));
  EXPECT_THAT(outcome.output, HasSubstr("dry friction of 1.2 N (body.body.coulomb)"));
}

TEST_F(IdentifyInTime, DrawsMotionModelAndResidual) {
  ASSERT_EQ(run(example + "--structure rigid --figure motion.svg").status, 0);
  const std::string figure = contents("motion.svg");
  EXPECT_THAT(figure, AllOf(HasSubstr("free_motion.csv: zoom on"), HasSubstr("Position (mm)"),
                            HasSubstr("fitted device with its dry friction"), HasSubstr("of the whole record")));
}

TEST_F(IdentifyInTime, SaysWhatIsNotForIt) {
  const auto errors = [&](const std::string& command) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.status, 2) << command;
    return outcome.errors;
  };
  EXPECT_THAT(errors(example + "--structure rigid --no-hold"), HasSubstr("--no-hold: is not for --method time-domain"));
  EXPECT_THAT(errors(example), HasSubstr("--structure: missing"));
  EXPECT_THAT(errors(example + "--structure rigid --segment-duration 0"), HasSubstr("--segment-duration: is 0 s"));
  EXPECT_THAT(errors("zwidth identify recordings/free_motion.csv recordings/free_motion.csv --force force --position "
                     "position --method inverse-dynamics"),
              HasSubstr("more than one recording: is not for --method inverse-dynamics"));
}

}  // namespace
}  // namespace zwidth::cli
