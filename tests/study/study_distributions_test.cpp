#include "zwidth/study/study_distributions.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "lhifam.hpp"
#include "zwidth/error.hpp"

namespace zwidth {
namespace {

using Kind = Distribution::Kind;

StudyDistributions two(double correlation) {
  return {{{"body.motor.mass", {.kind = Kind::normal, .centre = 0.3, .deviation = 0.01}},
           {"link.stiffness", {.kind = Kind::uniform, .lower = 7e4, .upper = 9e4}}},
          {{1.0, correlation}, {correlation, 1.0}}};
}

// Of a Gaussian copula the rank correlation is 6/pi asin(r/2) whatever the marginals; here by the mean of the product of
// uniform ranks, whose standard error is 1/sqrt(N).
TEST(StudyInputs, TheCopulaHasTheRankCorrelationOfItsNormal) {
  const double r = 0.7;
  const StudyInputs inputs(two(r));
  constexpr std::size_t count = 20000;
  const SamplingPlan plan(SamplingScheme::random, count, 2, 5);
  double product = 0.0;
  double mean = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<double, 2> numbers{plan.uniform(i, 0), plan.uniform(i, 1)};
    inputs.from_uniform(numbers);
    const double rank = standard_normal_probability((numbers[0] - 0.3) / 0.01);
    const double other = (numbers[1] - 7e4) / 2e4;
    product += (rank - 0.5) * (other - 0.5);
    mean += other;
  }
  EXPECT_NEAR(12.0 * product / count, 6.0 / M_PI * std::asin(r / 2.0), 5.0 / std::sqrt(count));
  EXPECT_NEAR(mean / count, 0.5, 5.0 * 0.289 / std::sqrt(count));
}

TEST(StudyDistributions, ProblemsHaveTheirPlace) {
  const Device device(test::lhifam_parameters());
  const auto key = [&](const StudyDistributions& distributions) {
    const auto problem = find_problem(device, distributions);
    return problem ? problem->key : "";
  };
  EXPECT_EQ(key(two(0.5)), "");
  EXPECT_EQ(key({}), "parameter");
  EXPECT_EQ(key(two(1.0)), "correlation.matrix");
  EXPECT_EQ(key(two(1.5)), "correlation.matrix");
  StudyDistributions wrong = two(0.0);
  wrong.parameters[1].key = "link.stifness";
  EXPECT_EQ(key(wrong), "parameter.1.key");
  wrong.parameters[1].key = "body.motor.mass";
  EXPECT_EQ(key(wrong), "parameter.1.key");
  wrong = two(0.0);
  wrong.parameters[0].distribution.deviation = -1.0;
  EXPECT_EQ(key(wrong), "parameter.0.deviation");
  wrong.parameters[0].distribution.deviation = 0.1;  // 0.3 kg is three deviations from no mass
  EXPECT_EQ(key(wrong), "parameter.0");
  wrong.parameters[0].distribution.lower = 0.01;
  EXPECT_EQ(key(wrong), "");
  // Each pair is possible, the three together are not.
  StudyDistributions three = two(0.0);
  three.parameters.push_back({"body.handle.mass", {.kind = Kind::uniform, .lower = 4.0, .upper = 6.0}});
  three.correlation = {{1.0, 0.9, -0.9}, {0.9, 1.0, 0.9}, {-0.9, 0.9, 1.0}};
  EXPECT_EQ(key(three), "correlation.matrix");
}

}  // namespace
}  // namespace zwidth
