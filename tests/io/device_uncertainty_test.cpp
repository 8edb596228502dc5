// The [uncertainty] table of a device file: read, written, refused with its place.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "io/device_texts.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

std::string uncertainty(const std::string& parameters, const std::string& covariance) {
  return two_body_text + "[uncertainty]\nparameters = " + parameters + "\ncovariance = " + covariance + "\n";
}

std::string message_of(const std::string& text) {
  const auto device = parse_device(text, "f.toml");
  return device ? "no error" : device.error().str();
}

TEST(DeviceUncertainty, IsReadAsWritten) {
  const auto device =
      parse_device(uncertainty("[\"link.stiffness\", \"body.handle.mass\"]", "[[4e4, -3.0], [-3.0, 1e-2]]"), "f.toml");
  ASSERT_TRUE(device.has_value()) << device.error().str();
  ASSERT_TRUE(device->parameters().uncertainty.has_value());
  EXPECT_EQ(device->parameters().uncertainty->parameters,
            (std::vector<std::string>{"link.stiffness", "body.handle.mass"}));
  EXPECT_EQ(device->parameters().uncertainty->covariance,
            (std::vector<std::vector<double>>{{4e4, -3.0}, {-3.0, 1e-2}}));
}

TEST(DeviceUncertainty, IsAbsentUnlessGiven) {
  const auto device = parse_device(two_body_text, "f.toml");
  ASSERT_TRUE(device.has_value());
  EXPECT_FALSE(device->parameters().uncertainty.has_value());
  EXPECT_EQ(write_device(device->parameters()).find("uncertainty"), std::string::npos);
}

// What identify could not carry stays in the file: with parameters or without.
TEST(DeviceUncertainty, AVerdictSurvivesTheFile) {
  const auto original = parse_device(two_body_text, "f.toml");
  ASSERT_TRUE(original.has_value());
  const std::vector<std::string> reasons{"the band ends below the crossover; excite up to 40 Hz", "\"quoted\""};
  for (const Uncertainty& uncertainty :
       {Uncertainty{{}, {}, "nothing is determined", Trust::Verdict::refused, reasons},
        Uncertainty{{"link.stiffness"}, {{4e4}}, "", Trust::Verdict::doubtful, reasons},
        Uncertainty{{"link.stiffness"}, {{4e4}}, "misfit", Trust::Verdict::sound, {}},
        Uncertainty{{}, {}, "", Trust::Verdict::refused, {}},
        Uncertainty{{}, {}, "", Trust::Verdict::sound, {}, {"body.motor.mass", "loop.sampling_period"}},
        Uncertainty{{"link.stiffness"}, {{4e4}}, "", Trust::Verdict::doubtful, reasons, {"link.damping"}}}) {
    DeviceParameters device = original->parameters();
    device.uncertainty = uncertainty;
    const auto again = parse_device(write_device(device), "f.toml");
    ASSERT_TRUE(again.has_value()) << again.error().str();
    ASSERT_TRUE(again->parameters().uncertainty.has_value());
    EXPECT_EQ(again->parameters().uncertainty->parameters, uncertainty.parameters);
    EXPECT_EQ(again->parameters().uncertainty->warning, uncertainty.warning);
    EXPECT_EQ(again->parameters().uncertainty->verdict, uncertainty.verdict);
    EXPECT_EQ(again->parameters().uncertainty->reasons, uncertainty.reasons);
    EXPECT_EQ(again->parameters().uncertainty->assumed, uncertainty.assumed);
  }
}

TEST(DeviceUncertainty, AnUnknownVerdictIsRefused) {
  EXPECT_EQ(message_of(two_body_text + "[uncertainty]\nverdict = \"fine\"\nwarning = \"x\"\n"),
            "f.toml:13:11: uncertainty.verdict: is \"fine\"; must be \"sound\", \"doubtful\" or \"refused\"");
}

// Random covariances A A^T of all sizes and units come back to the last digit.
TEST(DeviceUncertainty, SurvivesTheFile) {
  const std::vector<std::string> keys{"body.motor.mass", "body.handle.mass", "link.0.stiffness",
                                      "loop.sampling_period"};
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal;
    const std::size_t n = 1 + seed % keys.size();
    std::vector<std::vector<double>> root(n, std::vector<double>(n));
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j <= i; ++j)
        root[i][j] = normal(random) * std::pow(10.0, 3.0 * static_cast<double>(i) - 5.0);
    }
    std::vector<std::vector<double>> covariance(n, std::vector<double>(n, 0.0));
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t k = 0; k < n; ++k) covariance[i][j] += root[i][k] * root[j][k];
      }
    }
    DeviceParameters device = parse_device(two_body_text, "f.toml")->parameters();
    device.uncertainty = Uncertainty{{keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(n)}, covariance};
    const auto again = parse_device(write_device(device), "written.toml");
    ASSERT_TRUE(again.has_value()) << again.error().str();
    EXPECT_EQ(again->parameters().uncertainty->parameters, device.uncertainty->parameters);
    EXPECT_EQ(again->parameters().uncertainty->covariance, covariance);
  }
}

TEST(DeviceUncertainty, CanBeSetOnTheCommandLine) {
  const std::vector<std::string> overrides{"uncertainty.parameters=[\"link.stiffness\"]",
                                           "uncertainty.covariance=[[100]]"};
  const auto device = parse_device(two_body_text, "f.toml", overrides);
  ASSERT_TRUE(device.has_value()) << device.error().str();
  EXPECT_EQ(device->parameters().uncertainty->covariance[0][0], 100.0);
}

struct Refused {
  std::string name;
  std::string parameters;
  std::string covariance;
  std::string message;  // after "f.toml:"
};

class RefusedUncertainty : public testing::TestWithParam<Refused> {};

TEST_P(RefusedUncertainty, IsNamedWithItsPlace) {
  EXPECT_EQ(message_of(uncertainty(GetParam().parameters, GetParam().covariance)), "f.toml:" + GetParam().message);
}

const std::string one = "[\"link.stiffness\"]";
const std::string two = "[\"link.stiffness\", \"body.motor.mass\"]";

const Refused refused[] = {
    {"empty", "[]", "[]",
     "13:14: uncertainty.parameters: is empty; must be one or more keys; or leave out [uncertainty]"},
    {"unknown_key", "[\"link.stifness\"]", "[[1]]",
     "13:14: uncertainty.parameters: \"link.stifness\" is no parameter of the device; must be keys such as "
     "body.NAME.mass, link.0.stiffness or loop.delay"},
    {"absent_value", "[\"wall.stiffness\"]", "[[1]]",
     "13:14: uncertainty.parameters: \"wall.stiffness\" has no value in the device; give it one, or leave it out here"},
    {"given_twice", "[\"link.stiffness\", \"link.0.stiffness\"]", "[[1, 0], [0, 1]]",
     "13:14: uncertainty.parameters: \"link.0.stiffness\" stands twice; must be different keys"},
    {"not_text", "[3]", "[[1]]",
     "13:15: uncertainty.parameters: is the number 3; every element must be text in quotes"},
    {"no_array", "\"link.stiffness\"", "[[1]]",
     "13:14: uncertainty.parameters: is the text \"link.stiffness\"; must be an array of keys such as "
     "\"link.0.stiffness\""},
    {"too_few_rows", two, "[[1, 0]]",
     "14:14: uncertainty.covariance: has 1 rows; must have a row for each of the 2 parameters"},
    {"short_row", two, "[[1, 0], [0]]",
     "14:14: uncertainty.covariance: row 2 has 1 numbers; must have a number for each of the 2 parameters"},
    {"flat", one, "[1]", "14:15: uncertainty.covariance: is the number 1; every row must be an array of numbers"},
    {"text_in_row", one, "[[\"x\"]]",
     "14:16: uncertainty.covariance: is the text \"x\"; every element must be a number"},
    {"negative_variance", one, "[[-1]]",
     "14:14: uncertainty.covariance: the variance of \"link.stiffness\" is -1; must be 0 or from 1e-60 to 1e+60"},
    {"not_a_number", one, "[[nan]]",
     "14:14: uncertainty.covariance: the variance of \"link.stiffness\" is nan; must be 0 or from 1e-60 to 1e+60"},
    {"not_symmetric", two, "[[1, 0.5], [0.4, 1]]",
     "14:14: uncertainty.covariance: rows 1 and 2 have 0.5 and 0.4 for one pair; must be a symmetric matrix of finite "
     "numbers"},
    {"infinite", two, "[[1, inf], [inf, 1]]",
     "14:14: uncertainty.covariance: rows 1 and 2 have inf and inf for one pair; must be a symmetric matrix of finite "
     "numbers"},
    {"beyond_correlation", two, "[[1, 2], [2, 1]]",
     "14:14: uncertainty.covariance: \"link.stiffness\" and \"body.motor.mass\" have a covariance of 2; must be at "
     "most "
     "the product of their standard deviations, 1"},
    {"not_semidefinite", "[\"link.stiffness\", \"body.motor.mass\", \"body.handle.mass\"]",
     "[[1, 0.9, 0.9], [0.9, 1, -0.9], [0.9, -0.9, 1]]",
     "14:14: uncertainty.covariance: is no covariance: some combination of the parameters would have a negative "
     "variance; must be positive semidefinite"},
};

INSTANTIATE_TEST_SUITE_P(All, RefusedUncertainty, testing::ValuesIn(refused),
                         [](const auto& instance) { return instance.param.name; });

TEST(DeviceUncertainty, MissingAndUnknownKeysAreNamed) {
  EXPECT_EQ(message_of(two_body_text + "[uncertainty]\ncovariance = [[1]]\n"),
            "f.toml:12:1: uncertainty.parameters: is missing; must be given as an array of keys such as "
            "\"link.0.stiffness\"");
  EXPECT_EQ(message_of(two_body_text + "[uncertainty]\nparameter = 3\n"),
            "f.toml:13:1: uncertainty.parameter: unknown key \"parameter\"; did you mean \"parameters\"?");
}

TEST(DeviceUncertainty, AssumedNumbersAreOfTheDeviceEachOnce) {
  const auto message = [](const std::string& assumed) {
    return message_of(two_body_text + "[uncertainty]\nassumed = " + assumed + "\n");
  };
  EXPECT_EQ(message("[]"), "no error");
  EXPECT_FALSE(parse_device(two_body_text + "[uncertainty]\nassumed = []\n", "f.toml")->parameters().uncertainty);
  EXPECT_EQ(message("[\"body.motor.mas\"]"),
            "f.toml:13:11: uncertainty.assumed: \"body.motor.mas\" is no parameter of the device; must be keys such as "
            "body.NAME.mass, link.0.stiffness or loop.delay");
  EXPECT_EQ(message("[\"link.stiffness\", \"link.0.stiffness\"]"),
            "f.toml:13:11: uncertainty.assumed: \"link.0.stiffness\" stands twice; must be different keys");
  EXPECT_EQ(message("\"body.motor.mass\""),
            "f.toml:13:11: uncertainty.assumed: is the text \"body.motor.mass\"; must be an array of keys such as "
            "\"body.motor.mass\"");
}

TEST(DeviceUncertainty, HasAtMostAHundredParameters) {
  std::string keys = "[";
  for (int i = 0; i < 101; ++i) keys += "\"k" + std::to_string(i) + "\",\n";
  EXPECT_EQ(message_of(uncertainty(keys + "]", "[]")),
            "f.toml:13:14: uncertainty.parameters: has 101 keys; must be at most 100 keys");
}

}  // namespace
}  // namespace zwidth
