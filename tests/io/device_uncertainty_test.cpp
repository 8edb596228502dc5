// The [uncertainty] table of a device file: read, written, refused with its place.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "io/device_texts.hpp"
#include "io/problem_data.hpp"
#include "zwidth/io/device_file.hpp"

namespace zwidth {
namespace {

std::string uncertainty(const std::string& parameters, const std::string& covariance) {
  return two_body_text + "[uncertainty]\nparameters = " + parameters + "\ncovariance = " + covariance + "\n";
}

InputProblem problem_of(const std::string& text) {
  const auto device = parse_device(text, "f.toml");
  return device ? InputProblem{{}, "is read", "", {}} : InputProblem(device.error());
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
  test::expect_refused(problem_of(two_body_text + "[uncertainty]\nverdict = \"fine\"\nwarning = \"x\"\n"),
                       {{"f.toml", 13, 11, "uncertainty.verdict"},
                        {.code = ProblemCode::not_one_of,
                         .subjects = {{"given", "fine"}, {"choices", "\"sound\", \"doubtful\" or \"refused\""}}}});
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

struct BadUncertainty {
  std::string name;
  std::string parameters;
  std::string covariance;
  test::RefusedProblem refused;
};

class RefusedUncertainty : public testing::TestWithParam<BadUncertainty> {};

TEST_P(RefusedUncertainty, IsNamedWithItsPlace) {
  test::expect_refused(problem_of(uncertainty(GetParam().parameters, GetParam().covariance)), GetParam().refused);
}

const std::string one = "[\"link.stiffness\"]";
const std::string two = "[\"link.stiffness\", \"body.motor.mass\"]";

const BadUncertainty refused[] = {
    {"empty",
     "[]",
     "[]",
     {{"f.toml", 13, 14, "uncertainty.parameters"}, {.code = ProblemCode::uncertainty_says_nothing}}},
    {"unknown_key",
     "[\"link.stifness\"]",
     "[[1]]",
     {{"f.toml", 13, 14, "uncertainty.parameters"},
      {.code = ProblemCode::no_parameter_of_device, .subjects = {{"name", "link.stifness"}}}}},
    {"absent_value",
     "[\"wall.stiffness\"]",
     "[[1]]",
     {{"f.toml", 13, 14, "uncertainty.parameters"},
      {.code = ProblemCode::number_without_value, .subjects = {{"name", "wall.stiffness"}}}}},
    {"given_twice",
     "[\"link.stiffness\", \"link.0.stiffness\"]",
     "[[1, 0], [0, 1]]",
     {{"f.toml", 13, 14, "uncertainty.parameters"},
      {.code = ProblemCode::given_twice, .subjects = {{"name", "link.0.stiffness"}}}}},
    {"not_text",
     "[3]",
     "[[1]]",
     {{"f.toml", 13, 15, "uncertainty.parameters"},
      {.code = ProblemCode::of_other_type, .evidence = {{"number", 3.0}}, .subjects = {{"needed", "text"}}}}},
    {"no_array",
     "\"link.stiffness\"",
     "[[1]]",
     {{"f.toml", 13, 14, "uncertainty.parameters"},
      {.code = ProblemCode::of_other_type,
       .subjects = {{"text", "link.stiffness"}, {"needed", "keys"}, {"example", "link.0.stiffness"}}}}},
    {"too_few_rows",
     two,
     "[[1, 0]]",
     {{"f.toml", 14, 14, "uncertainty.covariance"},
      {.code = ProblemCode::covariance_rows_missing, .evidence = {{"rows", 1.0}, {"parameters", 2.0}}}}},
    {"short_row",
     two,
     "[[1, 0], [0]]",
     {{"f.toml", 14, 14, "uncertainty.covariance"},
      {.code = ProblemCode::covariance_numbers_missing, .evidence = {{"row", 2.0}, {"numbers", 1.0}}}}},
    {"flat",
     one,
     "[1]",
     {{"f.toml", 14, 15, "uncertainty.covariance"},
      {.code = ProblemCode::of_other_type,
       .evidence = {{"number", 1.0}, {"row", 1.0}},
       .subjects = {{"needed", "numbers"}}}}},
    {"text_in_row",
     one,
     "[[\"x\"]]",
     {{"f.toml", 14, 16, "uncertainty.covariance"},
      {.code = ProblemCode::of_other_type, .subjects = {{"text", "x"}, {"needed", "number"}}}}},
    {"negative_variance",
     one,
     "[[-1]]",
     {{"f.toml", 14, 14, "uncertainty.covariance"},
      {.code = ProblemCode::no_variance, .evidence = {{"value", -1.0}}, .subjects = {{"name", "link.stiffness"}}}}},
    {"not_a_number",
     one,
     "[[nan]]",
     {{"f.toml", 14, 14, "uncertainty.covariance"},
      {.code = ProblemCode::no_variance,
       .evidence = {{"value", std::nan("")}},
       .subjects = {{"name", "link.stiffness"}}}}},
    {"not_symmetric",
     two,
     "[[1, 0.5], [0.4, 1]]",
     {{"f.toml", 14, 14, "uncertainty.covariance"},
      {.code = ProblemCode::covariance_not_symmetric,
       .evidence = {{"row", 1.0}, {"other", 2.0}, {"value", 0.5}, {"mirrored", 0.4}}}}},
    {"infinite",
     two,
     "[[1, inf], [inf, 1]]",
     {{"f.toml", 14, 14, "uncertainty.covariance"},
      {.code = ProblemCode::covariance_not_symmetric,
       .evidence = {{"row", 1.0}, {"other", 2.0}, {"value", INFINITY}, {"mirrored", INFINITY}}}}},
    {"beyond_correlation",
     two,
     "[[1, 2], [2, 1]]",
     {{"f.toml", 14, 14, "uncertainty.covariance"},
      {.code = ProblemCode::covariance_too_large,
       .evidence = {{"value", 2.0}, {"most", 1.0}},
       .subjects = {{"name", "link.stiffness"}, {"other", "body.motor.mass"}}}}},
    {"not_semidefinite",
     "[\"link.stiffness\", \"body.motor.mass\", \"body.handle.mass\"]",
     "[[1, 0.9, 0.9], [0.9, 1, -0.9], [0.9, -0.9, 1]]",
     {{"f.toml", 14, 14, "uncertainty.covariance"}, {.code = ProblemCode::no_covariance}}},
};

INSTANTIATE_TEST_SUITE_P(All, RefusedUncertainty, testing::ValuesIn(refused),
                         [](const auto& instance) { return instance.param.name; });

TEST(DeviceUncertainty, MissingAndUnknownKeysAreNamed) {
  test::expect_refused(
      problem_of(two_body_text + "[uncertainty]\ncovariance = [[1]]\n"),
      {{"f.toml", 12, 1, "uncertainty.parameters"},
       {.code = ProblemCode::is_missing, .subjects = {{"needed", "keys"}, {"example", "link.0.stiffness"}}}});
  test::expect_refused(
      problem_of(two_body_text + "[uncertainty]\nparameter = 3\n"),
      {{"f.toml", 13, 1, "uncertainty.parameter"},
       {.code = ProblemCode::unknown_key, .subjects = {{"name", "parameter"}, {"meant", "parameters"}}}});
}

TEST(DeviceUncertainty, AssumedNumbersAreOfTheDeviceEachOnce) {
  const auto problem = [](const std::string& assumed) {
    return problem_of(two_body_text + "[uncertainty]\nassumed = " + assumed + "\n");
  };
  EXPECT_FALSE(parse_device(two_body_text + "[uncertainty]\nassumed = []\n", "f.toml")->parameters().uncertainty);
  test::expect_refused(problem("[\"body.motor.mas\"]"),
                       {{"f.toml", 13, 11, "uncertainty.assumed"},
                        {.code = ProblemCode::no_parameter_of_device, .subjects = {{"name", "body.motor.mas"}}}});
  test::expect_refused(problem("[\"link.stiffness\", \"link.0.stiffness\"]"),
                       {{"f.toml", 13, 11, "uncertainty.assumed"},
                        {.code = ProblemCode::given_twice, .subjects = {{"name", "link.0.stiffness"}}}});
  test::expect_refused(
      problem("\"body.motor.mass\""),
      {{"f.toml", 13, 11, "uncertainty.assumed"},
       {.code = ProblemCode::of_other_type,
        .subjects = {{"text", "body.motor.mass"}, {"needed", "keys"}, {"example", "body.motor.mass"}}}});
}

TEST(DeviceUncertainty, HasAtMostAHundredParameters) {
  std::string keys = "[";
  for (int i = 0; i < 101; ++i) keys += "\"k" + std::to_string(i) + "\",\n";
  test::expect_refused(problem_of(uncertainty(keys + "]", "[]")),
                       {{"f.toml", 13, 14, "uncertainty.parameters"},
                        {.code = ProblemCode::too_many_uncertain, .evidence = {{"keys", 101.0}, {"most", 100.0}}}});
}

}  // namespace
}  // namespace zwidth
