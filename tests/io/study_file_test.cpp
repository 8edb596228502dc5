#include "zwidth/io/study_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>

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

std::string refusal(const std::string& text, const Device& of = device) {
  const auto study = parse_study(text, "study.toml", of);
  return study ? "" : study.error().str();
}

std::string parameter_with(const std::string& lines) { return "[[parameter]]\n" + lines; }

TEST(StudyFile, RefusesWithThePlace) {
  const auto begins = [](const std::string& text, const std::string& with) {
    const std::string said = refusal(text);
    EXPECT_TRUE(said.starts_with(with)) << said;
  };
  begins("sample = 3\n", "study.toml:1:1: sample: unknown key \"sample\"; did you mean \"samples\"?");
  begins("samples = 3.5\n", "study.toml:1:11: samples: is 3.5; must be a whole number");
  begins("sampling = \"sobel\"\n", "study.toml:1:12: sampling: is \"sobel\"; must be \"random\"");
  begins("", "study.toml:1:1: parameter: none is given");
  begins("[specification]\ncritical_stiffness = \"3 kg\"\n", "study.toml:2:22: specification.critical_stiffness: ");
  begins("[specification]\nany_user = 0\n", "study.toml:2:12: specification.any_user: is 0; must be finite and > 0");
  begins(parameter_with("key = \"link.stifness\"\n"),
         "study.toml:2:7: parameter.0.key: \"link.stifness\" is no number of the device");
  begins(parameter_with("key = \"link.stiffness\"\ndistribution = \"gauss\"\n"),
         "study.toml:3:16: parameter.0.distribution: is \"gauss\"");
  begins(parameter_with("key = \"link.stiffness\"\ndistribution = \"normal\"\n"),
         "study.toml:1:1: parameter.0.standard_deviation: is missing");
  begins(parameter_with("key = \"link.stiffness\"\ndistribution = \"normal\"\nmode = 3\n"),
         "study.toml:4:1: parameter.0.mode: unknown key \"mode\"");
  begins(parameter_with("key = \"link.stiffness\"\ndistribution = \"normal\"\nstandard_deviation = 2e4\n"),
         "study.toml:1:1: parameter.0: link.stiffness: reaches -");
  begins(parameter_with("key = \"link.stiffness\"\ndistribution = \"uniform\"\nlower = 2\nupper = 1\n"),
         "study.toml:5:9: parameter.0.upper: is 1; must be above the lower end, 2");
  begins(parameter_with("key = \"link.stiffness\"\ndistribution = \"device\"\n"),
         "study.toml:3:16: parameter.0.distribution: the device's [uncertainty] does not tell link.stiffness");
  begins(parameter_with("key = \"loop.delay\"\ndistribution = \"file\"\nfile = \"none.txt\"\n"),
         "study.toml:4:8: parameter.0.file: ./none.txt: ");
  std::string twice = whole;
  twice += "[[parameter]]\nkey = \"link.0.stiffness\"\ndistribution = \"uniform\"\nlower = 1\nupper = 2\n";
  begins(twice, "study.toml:30:7: parameter.4.key: \"link.0.stiffness\" is given twice");
  std::string definite = whole;
  definite.replace(definite.find("[[1, 0.5], [0.5, 1]]"), 20, "[[1, 1.0], [1.0, 1]]");
  begins(definite, "study.toml:28:10: correlation.matrix: is not positive definite");
  begins("a = [\n", "study.toml:");
  begins("a = 1\na = 2\n", "study.toml:2:");
  EXPECT_TRUE(refusal("a = [\n").ends_with("must be the TOML text of a study")) << refusal("a = [\n");
  const std::string normal = "key = \"link.stiffness\"\ndistribution = \"normal\"\n";
  begins(parameter_with(normal + "mean = nan\nstandard_deviation = 1\n"),
         "study.toml:4:8: parameter.0.mean: is nan; must be finite");
  begins(parameter_with(normal + "standard_deviation = 1\nlower = nan\n"),
         "study.toml:5:9: parameter.0.lower: is nan; must be a number");
  begins(parameter_with(normal + "standard_deviation = 1\nupper = nan\n"),
         "study.toml:5:9: parameter.0.upper: is nan; must be a number");
  begins(parameter_with(normal + "standard_deviation = inf\n"),
         "study.toml:4:22: parameter.0.standard_deviation: is inf; must be finite and > 0");
  begins(parameter_with(normal + "relative_deviation = -0.1\n"),
         "study.toml:4:22: parameter.0.relative_deviation: is -0.1, of a mean of 79500; must be finite and > 0");
  begins(parameter_with("key = \"link.stiffness\"\ndistribution = \"uniform\"\nrelative_tolerance = -0.1\n"),
         "study.toml:4:22: parameter.0.relative_tolerance: leaves no width; must be > 0");
  begins(parameter_with("key = \"link.stiffness\"\ndistribution = \"lognormal\"\nlog_deviation = 0\n"),
         "study.toml:4:17: parameter.0.log_deviation: is 0; must be finite and > 0");
  begins(parameter_with("key = \"loop.delay\"\ndistribution = \"triangular\"\nlower = 1e-4\nupper = 2e-4\nmode = 1\n"),
         "study.toml:6:8: parameter.0.mode: is 1; ");
  const std::string discrete = "key = \"body.motor.mass\"\ndistribution = \"discrete\"\n";
  begins(parameter_with(discrete + "values = [1, 2]\nweights = [0, 0]\n"),
         "study.toml:5:11: parameter.0.weights: are all 0; must be > 0 for one value");
  EXPECT_THAT(refusal(parameter_with(discrete + "values = [-1, 2]\n")),
              ::testing::EndsWith("body.motor.mass must be a finite number > 0; leave that value out"));
  begins(parameter_with(discrete + "values = [1, \"2 m\"]\n"), "study.toml:4:14: parameter.0.values: \"m\" is no unit");
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
  EXPECT_THAT(refused.error().str(), ::testing::HasSubstr("commas.txt:2: \"0,25\" is no sample; must be a number"));
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
