#include "identification/evidence/likelihood.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>

#include "identification/evidence/limit_evidence.hpp"
#include "identification/evidence/response_evidence.hpp"
#include "identification/optimiser/minimise.hpp"
#include "lhifam.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {
namespace {

using test::lhifam_parameters;

using Scale = Number::Scale;

Number about(const char* key, Scale scale, double unit, double deviation) {
  return {key, scale, unit, scale == Scale::logarithmic ? 0.0 : 1.0, deviation};
}

/// Units are the true values: x = 0 of what is logarithmic, 1 of the rest.
std::vector<Number> free_numbers() {
  const double open = std::numeric_limits<double>::infinity();
  return {about("body.motor.mass", Scale::logarithmic, 0.3, open),
          about("body.motor.damping", Scale::not_negative, 0.1, open),
          about("body.handle.mass", Scale::logarithmic, 5.1, open),
          about("body.handle.damping", Scale::not_negative, 3.4, open),
          about("link.0.stiffness", Scale::logarithmic, 79.5e3, open),
          about("link.0.damping", Scale::not_negative, 15.0, open)};
}

Eigen::VectorXd true_coordinates() { return (Eigen::VectorXd(6) << 0, 1, 0, 1, 0, 1).finished(); }
Eigen::VectorXd start_coordinates() { return (Eigen::VectorXd(6) << 0.1, 1.5, -0.1, 0.8, 0.05, 0.7).finished(); }

FrequencyResponse exact_lines() {
  const Device device(lhifam_parameters());
  const SampledPlant plant = sampled_plant(device);
  FrequencyResponse made;
  made.sampling_period = device.loop().sampling_period;
  for (double hz = 0.5; hz < 300.0; hz *= 1.07) {
    const double w = 2.0 * std::numbers::pi * hz;
    made.points.push_back({.frequency = w, .value = response(plant, w)});
  }
  return made;
}

MeasuredLimit limit_of(double stiffness, double damping, std::optional<double> frequency_hz) {
  MeasuredLimit made;
  made.stiffness = stiffness;
  made.damping = damping;
  made.frequency_hz = frequency_hz;
  return made;
}

std::vector<MeasuredLimit> exact_limits() {
  std::vector<MeasuredLimit> made;
  const Device device(lhifam_parameters());
  for (const double damping : {0.0, 5.0, 20.0}) {
    VirtualDamper damper = virtual_damper(device);
    damper.damping = damping;
    const auto limit = critical_stiffness(filtered_plant(device), damper).limit;
    if (limit) made.push_back(limit_of(limit->stiffness, damping, limit->frequency / (2.0 * std::numbers::pi)));
  }
  return made;
}

TEST(Likelihood, GradientIsTheDifferenceOfCosts) {
  const DeviceFamily family(lhifam_parameters(), free_numbers(), {});
  ASSERT_EQ(family.of_device(), 6);
  const Likelihood sum(family.numbers(), {std::make_shared<ResponseEvidence>(family, exact_lines()),
                                          std::make_shared<LimitEvidence>(family, exact_limits())});
  const Eigen::VectorXd z = sum.start(start_coordinates());
  const auto picture = sum.picture(z);
  ASSERT_TRUE(picture);
  EXPECT_DOUBLE_EQ(picture->cost, sum.cost(z).value());
  for (Eigen::Index i = 0; i < z.size(); ++i) {
    constexpr double h = 1e-5;
    Eigen::VectorXd above = z;
    Eigen::VectorXd below = z;
    above(i) += h;
    below(i) -= h;
    const double difference = (sum.cost(above).value() - sum.cost(below).value()) / (2.0 * h);
    EXPECT_NEAR(picture->gradient(i), difference, 1e-4 * (1.0 + std::abs(difference))) << i;
  }
}

TEST(Likelihood, ExactLinesGiveTheNumbersBack) {
  const DeviceFamily family(lhifam_parameters(), free_numbers(), {});
  const Likelihood sum(family.numbers(), {std::make_shared<ResponseEvidence>(family, exact_lines())});
  const auto found = minimise(sum, sum.start(start_coordinates()), {.most_steps = 100, .least_gain = 1e-9});
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->settled);
  EXPECT_LT((found->z.head(6) - true_coordinates()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Likelihood, LimitsBesideAFileNarrowADamping) {
  std::vector<Number> numbers = free_numbers();
  for (Number& each : numbers) each.prior_deviation = 0.01;  // a file's
  numbers.back().expected = 2.0;                             // but for the link's damping, twice the truth
  numbers.back().prior_deviation = 1.0;
  const DeviceFamily family(lhifam_parameters(), numbers, {});
  std::vector<MeasuredLimit> limits = exact_limits();
  ASSERT_EQ(limits.size(), 3U);
  for (MeasuredLimit& each : limits) each.stiffness_deviation = 0.02;
  const Likelihood sum(numbers, {std::make_shared<LimitEvidence>(family, limits)});
  Eigen::VectorXd start = true_coordinates();
  start(5) = 2.0;
  const auto found = minimise(sum, start);
  ASSERT_TRUE(found);
  const double deviation = std::sqrt(found->picture.hessian.inverse()(5, 5));
  EXPECT_LT(deviation, 0.1);
  EXPECT_LT(std::abs(found->z(5) - 1.0), 2.0 * deviation);
}

TEST(Likelihood, CostsAdd) {
  const DeviceFamily family(lhifam_parameters(), free_numbers(), {});
  const auto lines = std::make_shared<ResponseEvidence>(family, exact_lines());
  const auto limits = std::make_shared<LimitEvidence>(family, exact_limits());
  const Likelihood both(family.numbers(), {lines, limits});
  const Eigen::VectorXd x = start_coordinates();
  const double sum = lines->cost(x, lines->own_start(x)).value() + limits->cost(x, Eigen::VectorXd(0)).value();
  EXPECT_NEAR(both.cost(both.start(x)).value(), sum, 1e-12 * std::abs(sum));
}

TEST(MeasuredLimit, NamesTheMemberOutOfItsRange) {
  EXPECT_FALSE(find_problem(limit_of(3.0, 0.0, 40.0)));
  EXPECT_FALSE(find_problem(limit_of(3.0, 0.0, std::nullopt)));
  EXPECT_EQ(find_problem(limit_of(0.0, 0.0, 40.0))->member, "stiffness");
  EXPECT_EQ(find_problem(limit_of(3.0, -1.0, 40.0))->member, "damping");
  EXPECT_EQ(find_problem(limit_of(3.0, 0.0, 0.0))->member, "frequency_hz");
}

}  // namespace
}  // namespace zwidth::internal
