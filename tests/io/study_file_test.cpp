#include "zwidth/io/study_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "io/refused_problem.hpp"
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

InputProblem refusal(const std::string& text) {
  const auto study = parse_study(text, "study.toml", device);
  return study ? InputProblem{{}, "is read", "", {}} : InputProblem(study.error());
}

std::string parameter_with(const std::string& lines) { return "[[parameter]]\n" + lines; }

TEST(StudyFile, RefusesWithThePlace) {
  using enum ProblemCode;
  const auto expect = [](const std::string& text, std::size_t line, std::size_t column, const std::string& key,
                         ProblemCode code, std::vector<Evidence> numbers = {}, std::vector<Subject> names = {}) {
    test::expect_refused(refusal(text),
                         {{"study.toml", line, column, key}, {code, std::move(numbers), std::move(names)}});
  };
  expect("sample = 3\n", 1, 1, "sample", unknown_key, {}, {{"name", "sample"}, {"meant", "samples"}});
  expect("samples = 3.5\n", 1, 11, "samples", no_whole_number, {{"value", 3.5}, {"least", 0.0}});
  expect("sampling = \"sobel\"\n", 1, 12, "sampling", not_one_of, {}, {{"given", "sobel"}});
  expect("", 1, 1, "parameter", no_parameters);
  expect("[specification]\ncritical_stiffness = \"3 kg\"\n", 2, 22, "specification.critical_stiffness",
         unit_of_other_measure);
  expect("[specification]\nany_user = 0\n", 2, 12, "specification.any_user", not_finite_and_positive, {{"value", 0.0}});
  expect(parameter_with("key = \"link.stifness\"\n"), 2, 7, "parameter.0.key", no_number_of_device, {},
         {{"name", "link.stifness"}, {"meant", "link.0.stiffness"}});
  expect(parameter_with("key = \"link.stiffness\"\ndistribution = \"gauss\"\n"), 3, 16, "parameter.0.distribution",
         not_one_of, {}, {{"given", "gauss"}});
  expect(parameter_with("key = \"link.stiffness\"\n"), 1, 1, "parameter.0.distribution", is_missing, {},
         {{"needed", "choice"}});
  expect(parameter_with("key = \"link.stiffness\"\ndistribution = \"normal\"\n"), 1, 1,
         "parameter.0.standard_deviation", is_missing, {}, {{"needed", "number"}});
  expect(parameter_with("key = \"link.stiffness\"\ndistribution = \"normal\"\nmode = 3\n"), 4, 1, "parameter.0.mode",
         unknown_key);
  expect(parameter_with("key = \"link.stiffness\"\ndistribution = \"normal\"\nstandard_deviation = 2e4\n"), 1, 1,
         "parameter.0", reaches_no_device, {}, {{"name", "link.stiffness"}});
  expect(parameter_with("key = \"link.stiffness\"\ndistribution = \"uniform\"\nlower = 2\nupper = 1\n"), 5, 9,
         "parameter.0.upper", not_above_lower_end, {{"value", 1.0}, {"least", 2.0}});
  expect(parameter_with("key = \"link.stiffness\"\ndistribution = \"device\"\n"), 3, 16, "parameter.0.distribution",
         not_told_by_uncertainty, {}, {{"name", "link.stiffness"}});
  expect(parameter_with("key = \"loop.delay\"\ndistribution = \"file\"\nfile = \"none.txt\"\n"), 4, 8,
         "parameter.0.file", cannot_be_read, {}, {{"kind", "file of samples"}});
  std::string twice = whole;
  twice += "[[parameter]]\nkey = \"link.0.stiffness\"\ndistribution = \"uniform\"\nlower = 1\nupper = 2\n";
  expect(twice, 30, 7, "parameter.4.key", parameter_given_twice);
  std::string definite = whole;
  definite.replace(definite.find("[[1, 0.5], [0.5, 1]]"), 20, "[[1, 1.0], [1.0, 1]]");
  expect(definite, 28, 10, "correlation.matrix", not_positive_definite);
  std::string flat = whole;
  flat.replace(flat.find("[[1, 0.5], [0.5, 1]]"), 20, "[[1, 0.5], [0.5]]");
  expect(flat, 28, 10, "correlation.matrix", row_of_other_length, {{"length", 1.0}, {"parameters", 2.0}});
  EXPECT_EQ(refusal("a = 1\na = 2\n").place.line, 2U);
  const InputProblem no_toml = refusal("a = [\n");
  ASSERT_TRUE(no_toml.problem);
  EXPECT_EQ(no_toml.problem->code, not_toml);
  EXPECT_EQ(no_toml.problem->subjects.back(), (Subject{"of", "a study"}));
  const std::string normal = "key = \"link.stiffness\"\ndistribution = \"normal\"\n";
  expect(parameter_with(normal + "mean = nan\nstandard_deviation = 1\n"), 4, 8, "parameter.0.mean", not_finite);
  expect(parameter_with(normal + "standard_deviation = 1\nlower = nan\n"), 5, 9, "parameter.0.lower", not_a_number);
  expect(parameter_with(normal + "standard_deviation = 1\nupper = nan\n"), 5, 9, "parameter.0.upper", not_a_number);
  expect(parameter_with(normal + "standard_deviation = inf\n"), 4, 22, "parameter.0.standard_deviation",
         not_finite_and_positive);
  expect(parameter_with(normal + "relative_deviation = -0.1\n"), 4, 22, "parameter.0.relative_deviation",
         no_relative_width, {{"value", -0.1}, {"of", 79500.0}});
  expect(parameter_with(normal + "relative_deviation = 0.1\nstandard_deviation = 1\n"), 4, 22,
         "parameter.0.relative_deviation", given_beside, {}, {{"other", "standard_deviation"}});
  const std::string uniform = "key = \"link.stiffness\"\ndistribution = \"uniform\"\n";
  expect(parameter_with(uniform + "relative_tolerance = -0.1\n"), 4, 22, "parameter.0.relative_tolerance",
         no_relative_width, {{"value", -0.1}, {"of", 79500.0}});
  expect(parameter_with(uniform + "relative_tolerance = 0.1\nupper = 1\n"), 4, 22, "parameter.0.relative_tolerance",
         given_beside, {}, {{"other", "upper"}});
  expect(parameter_with("key = \"link.stiffness\"\ndistribution = \"lognormal\"\nlog_deviation = 0\n"), 4, 17,
         "parameter.0.log_deviation", not_finite_and_positive, {{"value", 0.0}});
  const InputProblem mode = refusal(
      parameter_with("key = \"loop.delay\"\ndistribution = \"triangular\"\nlower = 1e-4\nupper = 2e-4\nmode = 1\n"));
  EXPECT_EQ(mode.place.line, 6U);
  EXPECT_EQ(mode.place.key, "parameter.0.mode");
  const std::string discrete = "key = \"body.motor.mass\"\ndistribution = \"discrete\"\n";
  expect(parameter_with(discrete + "values = [1, 2]\nweights = [0, 0]\n"), 5, 11, "parameter.0.weights",
         weights_all_zero);
  expect(parameter_with(discrete + "values = [1, 2]\nweights = [1]\n"), 5, 11, "parameter.0.weights",
         weights_not_one_a_value, {{"weights", 1.0}, {"values", 2.0}});
  const InputProblem reached = refusal(parameter_with(discrete + "values = [-1, 2]\n"));
  ASSERT_TRUE(reached.problem) << reached.str();
  EXPECT_EQ(reached.problem->code, reaches_no_device);
  EXPECT_TRUE(std::ranges::count(reached.problem->evidence, Evidence{"discrete", 1.0}));
  expect(parameter_with(discrete + "values = [1, \"2 m\"]\n"), 4, 14, "parameter.0.values", unit_of_other_measure, {},
         {{"unit", "m"}});
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
