#include "zwidth/io/study_file.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "lhifam.hpp"

namespace zwidth {
namespace {

using Kind = Distribution::Kind;

const Device device(test::lhifam_parameters());

constexpr const char* whole = R"(sampling = "latin-hypercube"
samples = 500
seed = 3
[specification]
critical_stiffness = "3 kN/m"
any_user = 2000
[[parameter]]
key = "link.stiffness"
distribution = "normal"
relative_deviation = 0.05
lower = 5e4
[[parameter]]
key = "loop.delay"
distribution = "triangular"
lower = 0
mode = "0.2 ms"
upper = "1 ms"
[[parameter]]
key = "body.motor.mass"
distribution = "uniform"
relative_tolerance = 0.1
[[parameter]]
key = "body.handle.damping"
distribution = "discrete"
values = [3, 1, 3]
[correlation]
parameters = ["body.motor.mass", "link.0.stiffness"]
matrix = [[1, 0.5], [0.5, 1]]
)";

TEST(StudyFile, SaysWhatVaries) {
  const auto study = parse_study(whole, "study.toml", device);
  ASSERT_TRUE(study) << study.error().str();
  EXPECT_EQ(study->sampling, SamplingScheme::latin_hypercube);
  EXPECT_EQ(study->samples, 500U);
  EXPECT_EQ(study->seed, 3U);
  EXPECT_EQ(study->specification.critical_stiffness, 3000.0);
  EXPECT_EQ(study->specification.any_user, 2000.0);
  const auto& parameters = study->distributions.parameters;
  ASSERT_EQ(parameters.size(), 4U);
  EXPECT_EQ(parameters[0].distribution.centre, 79.5e3);  // the device's own
  EXPECT_DOUBLE_EQ(parameters[0].distribution.deviation, 0.05 * 79.5e3);
  EXPECT_EQ(parameters[0].distribution.lower, 5e4);
  EXPECT_EQ(parameters[1].distribution.centre, 0.2e-3);
  EXPECT_DOUBLE_EQ(parameters[2].distribution.upper, 0.33);
  EXPECT_EQ(parameters[3].distribution.values, (std::vector<double>{1.0, 3.0}));
  EXPECT_EQ(parameters[3].distribution.weights, (std::vector<double>{1.0, 2.0}));
  EXPECT_EQ(study->distributions.correlation[0][2], 0.5);
  EXPECT_EQ(study->distributions.correlation[0][1], 0.0);
}

std::string parameter_with(const std::string& lines) { return "[[parameter]]\n" + lines; }

struct RefusedStudy {
  std::string text;
  std::string place;  // "LINE:COLUMN KEY"
  ProblemCode code;
};

std::vector<RefusedStudy> refused_studies() {
  using enum ProblemCode;
  const std::string link = "key = \"link.stiffness\"\n";
  const std::string normal = link + "distribution = \"normal\"\n";
  const std::string discrete = "key = \"body.motor.mass\"\ndistribution = \"discrete\"\n";
  const std::string twice =
      "[[parameter]]\nkey = \"link.0.stiffness\"\ndistribution = \"uniform\"\nlower = 1\nupper = 2\n";
  std::string indefinite = whole;
  indefinite.replace(indefinite.find("[[1, 0.5], [0.5, 1]]"), 20, "[[1, 1.0], [1.0, 1]]");
  std::string not_square = whole;
  not_square.replace(not_square.find("[[1, 0.5], [0.5, 1]]"), 20, "[[1, 0.5]]");
  std::string of_none = whole;
  of_none.replace(of_none.find("[\"body.motor.mass\", "), 20, "[\"loop.sampling_period\", ");
  return {
      {"sample = 3\n", "1:1 sample", unknown_key},
      {"samples = 3.5\n", "1:11 samples", no_whole_number},
      {"sampling = \"sobel\"\n", "1:12 sampling", not_one_of},
      {"", "1:1 parameter", no_parameters},
      {"[specification]\ncritical_stiffness = \"3 kg\"\n", "2:22 specification.critical_stiffness",
       unit_of_other_measure},
      {"[specification]\nany_user = 0\n", "2:12 specification.any_user", not_finite_and_positive},
      {parameter_with("distribution = \"normal\"\n"), "1:1 parameter.0.key", is_missing},
      {parameter_with("key = \"link.stifness\"\n"), "2:7 parameter.0.key", no_number_of_device},
      {parameter_with(link), "1:1 parameter.0.distribution", is_missing},
      {parameter_with(link + "distribution = \"gauss\"\n"), "3:16 parameter.0.distribution", not_one_of},
      {parameter_with(normal), "1:1 parameter.0.standard_deviation", is_missing},
      {parameter_with(normal + "mode = 3\n"), "4:1 parameter.0.mode", unknown_key},
      {parameter_with(normal + "standard_deviation = 2e4\n"), "1:1 parameter.0", reaches_no_device},
      {parameter_with(link + "distribution = \"uniform\"\nlower = 2\nupper = 1\n"), "5:9 parameter.0.upper",
       not_above_lower_end},
      {parameter_with(link + "distribution = \"uniform\"\nrelative_tolerance = 0.1\nupper = 1\n"),
       "4:22 parameter.0.relative_tolerance", given_beside},
      {parameter_with(link + "distribution = \"device\"\n"), "3:16 parameter.0.distribution", not_told_by_uncertainty},
      {parameter_with("key = \"loop.delay\"\ndistribution = \"file\"\n"), "1:1 parameter.0.file", is_missing},
      {parameter_with("key = \"loop.delay\"\ndistribution = \"file\"\nfile = \"none.txt\"\n"), "4:8 parameter.0.file",
       cannot_be_read},
      {whole + twice, "30:7 parameter.4.key", given_twice},
      {indefinite, "28:10 correlation.matrix", not_positive_definite},
      {not_square, "28:10 correlation.matrix", rows_not_one_a_parameter},
      {of_none, "27:14 correlation.parameters", not_a_parameter_of_study},
      {parameter_with(normal + "mean = nan\nstandard_deviation = 1\n"), "4:8 parameter.0.mean", not_finite},
      {parameter_with(normal + "standard_deviation = 1\nlower = nan\n"), "5:9 parameter.0.lower", not_a_number},
      {parameter_with(normal + "standard_deviation = 1\nupper = nan\n"), "5:9 parameter.0.upper", not_a_number},
      {parameter_with(normal + "standard_deviation = inf\n"), "4:22 parameter.0.standard_deviation",
       not_finite_and_positive},
      {parameter_with(normal + "relative_deviation = -0.1\n"), "4:22 parameter.0.relative_deviation",
       no_relative_width},
      {parameter_with(normal + "relative_deviation = 0.1\nstandard_deviation = 1\n"),
       "4:22 parameter.0.relative_deviation", given_beside},
      {parameter_with(link + "distribution = \"uniform\"\nrelative_tolerance = -0.1\n"),
       "4:22 parameter.0.relative_tolerance", no_relative_width},
      {parameter_with(link + "distribution = \"lognormal\"\nlog_deviation = 0\n"), "4:17 parameter.0.log_deviation",
       not_finite_and_positive},
      {parameter_with("key = \"loop.delay\"\ndistribution = \"triangular\"\nlower = 1e-4\nupper = 2e-4\nmode = 1\n"),
       "6:8 parameter.0.mode", not_between},
      {parameter_with(discrete + "values = [1, 2]\nweights = [1]\n"), "5:11 parameter.0.weights",
       weights_not_one_a_value},
      {parameter_with(discrete + "values = [1, 2]\nweights = [0, 0]\n"), "5:11 parameter.0.weights", weights_all_zero},
      {parameter_with(discrete + "values = [-1, 2]\n"), "1:1 parameter.0", reaches_no_device},
      {parameter_with(discrete + "values = [1, \"2 m\"]\n"), "4:14 parameter.0.values", unit_of_other_measure},
  };
}

TEST(StudyFile, RefusesWithThePlace) {
  for (const RefusedStudy& each : refused_studies()) {
    SCOPED_TRACE(each.text);
    const auto study = parse_study(each.text, "study.toml", device, ".");
    ASSERT_FALSE(study);
    const InputError& error = study.error();
    EXPECT_EQ(error.place.file, "study.toml");
    EXPECT_EQ(fmt::format("{}:{} {}", error.place.line, error.place.column, error.place.key), each.place);
    ASSERT_TRUE(error.problem) << error.str();
    EXPECT_EQ(error.problem->code, each.code) << error.str();
  }
}

TEST(StudyFile, RefusesWhatIsNoToml) {
  for (const auto& [text, line] : {std::pair{"a = [\n", 0U}, {"a = 1\na = 2\n", 2U}}) {
    const auto study = parse_study(text, "study.toml", device);
    ASSERT_FALSE(study);
    EXPECT_EQ(study.error().place.file, "study.toml");
    if (line > 0) {
      EXPECT_EQ(study.error().place.line, line);
    }
    ASSERT_TRUE(study.error().problem) << study.error().str();
    EXPECT_EQ(study.error().problem->code, ProblemCode::not_toml);
  }
}

TEST(StudyFile, NamesTheFileThatIsNotThere) {
  const auto study = parse_study(parameter_with("key = \"loop.delay\"\ndistribution = \"file\"\nfile = \"none.txt\"\n"),
                                 "study.toml", device, ".");
  ASSERT_FALSE(study);
  EXPECT_TRUE(study.error().what.starts_with("./none.txt: ")) << study.error().what;
}

TEST(StudyFile, NeedsAFolderForAFile) {
  const auto study = parse_study(parameter_with("key = \"loop.delay\"\ndistribution = \"file\"\nfile = \"none.txt\"\n"),
                                 "study.toml", device, std::nullopt);
  ASSERT_FALSE(study);
  ASSERT_TRUE(study.error().problem);
  EXPECT_EQ(study.error().problem->code, ProblemCode::no_file_beside_study);
}

TEST(StudyFile, TakesValuesWithUnits) {
  const auto study =
      parse_study("[[parameter]]\nkey = \"body.motor.mass\"\ndistribution = \"discrete\"\nvalues = [\"300 g\", 0.31]\n",
                  "study.toml", device);
  ASSERT_TRUE(study) << study.error().str();
  EXPECT_EQ(study->distributions.parameters[0].distribution.values, (std::vector<double>{0.3, 0.31}));
}

// What a device says of itself: its deviations, and their correlation.
TEST(StudyFile, TakesTheDevicesOwnUncertainty) {
  DeviceParameters parameters = device.parameters();
  parameters.uncertainty = Uncertainty{{"body.motor.mass", "link.0.stiffness"}, {{1e-4, 5.0}, {5.0, 1e6}}};
  const auto study = parse_study(
      "[[parameter]]\nkey = \"link.stiffness\"\ndistribution = \"device\"\n"
      "[[parameter]]\nkey = \"body.motor.mass\"\ndistribution = \"device\"\n",
      "study.toml", Device(parameters));
  ASSERT_TRUE(study) << study.error().str();
  EXPECT_DOUBLE_EQ(study->distributions.parameters[0].distribution.deviation, 1000.0);
  EXPECT_DOUBLE_EQ(study->distributions.correlation[1][0], 0.5);
}

TEST(StudyFile, TakesMeasuredSamples) {
  const std::string folder = ::testing::TempDir();
  std::ofstream(folder + "/delays.txt") << "# unit: us\n250 3\n\n400 1\n250\n";
  const auto study =
      parse_study("[[parameter]]\nkey = \"loop.delay\"\ndistribution = \"file\"\nfile = \"delays.txt\"\n", "study.toml",
                  device, folder);
  ASSERT_TRUE(study) << study.error().str();
  const Distribution& delay = study->distributions.parameters[0].distribution;
  ASSERT_EQ(delay.values.size(), 2U);
  EXPECT_NEAR(delay.values[0], 250e-6, 1e-18);
  EXPECT_EQ(delay.weights, (std::vector<double>{4.0, 1.0}));
}

// A comma may be a decimal one: 0,25 must not become 0, seen 25 times.
TEST(StudyFile, TakesNoCommaBetweenDigitsForASeparator) {
  const std::string folder = ::testing::TempDir();
  const std::string text = "[[parameter]]\nkey = \"loop.delay\"\ndistribution = \"file\"\nfile = \"commas.txt\"\n";
  std::ofstream(folder + "/commas.txt") << "# unit: ms\n0,25\n0,5\n";
  const auto refused = parse_study(text, "study.toml", device, folder);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().what, ::testing::HasSubstr("commas.txt:2: "));
  ASSERT_TRUE(refused.error().problem);
  EXPECT_EQ(*refused.error().problem,
            (Problem{.code = ProblemCode::no_samples_in_file, .subjects = {{"text", "0,25"}}}));
  std::ofstream(folder + "/commas.txt") << "250e-6, 3\n400e-6; 1\n";
  const auto study = parse_study(text, "study.toml", device, folder);
  ASSERT_TRUE(study) << study.error().str();
  EXPECT_EQ(study->distributions.parameters[0].distribution.weights, (std::vector<double>{3.0, 1.0}));
}

TEST(StudyFile, NeverThrowsOnAnyPrefix) {
  const std::string text = whole;
  for (std::size_t size = 0; size < text.size(); ++size) {
    EXPECT_NO_THROW((void)parse_study(text.substr(0, size), "study.toml", device)) << size;
  }
}

}  // namespace
}  // namespace zwidth
