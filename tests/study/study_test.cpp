#include "zwidth/study/study.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/study/study_run.hpp"

namespace zwidth {
namespace {

using Kind = Distribution::Kind;

Device two_masses() { return Device(test::lhifam_parameters()); }

StudyDistributions tolerances() {
  return {{{"body.motor.mass", {.kind = Kind::uniform, .lower = 0.27, .upper = 0.33}},
           {"link.stiffness", {.kind = Kind::normal, .centre = 79.5e3, .deviation = 6e3}},
           {"body.handle.damping", {.kind = Kind::triangular, .centre = 3.4, .lower = 1.0, .upper = 4.0}},
           {"loop.delay", {.kind = Kind::discrete, .values = {0.0, 1e-4, 2.5e-4}, .weights = {2.0, 1.0, 1.0}}}}};
}

/// Everything that a study says in numbers.
std::vector<double> numbers_of(const Study& study) {
  std::vector<double> numbers;
  if (study.yield) numbers = {study.yield->value, study.yield->lower, study.yield->upper};
  for (const QuantileEstimate& each : study.quantiles) {
    numbers.insert(numbers.end(), {each.value.value_or(-1.0), each.lower.value_or(-1.0), each.upper.value_or(-1.0)});
  }
  for (const std::uint64_t count : study.histogram.counts) numbers.push_back(static_cast<double>(count));
  for (const FailureCluster& each : study.clusters) {
    numbers.push_back(static_cast<double>(each.count));
    numbers.insert(numbers.end(), each.mean_scores.begin(), each.mean_scores.end());
  }
  if (study.sobol_indices) {
    for (const SobolIndex& each : *study.sobol_indices) numbers.insert(numbers.end(), {each.first, each.total});
  }
  if (study.tightening) {
    for (const TighteningGain& each : *study.tightening) numbers.push_back(each.yield_gain);
  }
  if (study.worst) {
    numbers.push_back(study.worst->critical.stiffness);
    numbers.insert(numbers.end(), study.worst->values.begin(), study.worst->values.end());
  }
  return numbers;
}

// A delay of none up to a millisecond: half of it is up to half a millisecond, not around that.
TEST(StudyTightening, IsAboutTheDevicesOwnValueWhereThatIsAnEnd) {
  const DeviceParameters parameters = test::rigid_parameters();
  const StudyDistributions distributions{
      {{"loop.delay", {.kind = Distribution::Kind::uniform, .lower = 0.0, .upper = 1e-3}}}};
  StudyOptions options;
  options.samples = 1000;
  options.index_samples = 0;
  options.worst = false;
  options.specification.critical_stiffness = critical_stiffness(Device(test::with_delay(parameters, 0.6e-3))).stiffness;
  const Study result = study(Device(parameters), distributions, options);
  EXPECT_NEAR(result.yield->value, 0.6, 0.05);
  EXPECT_DOUBLE_EQ(result.tightening->front().yield_gain, 1.0 - result.yield->value);
  EXPECT_EQ(result.tighten_first, std::optional<std::size_t>(0));
}

TEST(Study, IsTheSameForAnyNumberOfThreads) {
  for (const SamplingScheme sampling :
       {SamplingScheme::random, SamplingScheme::latin_hypercube, SamplingScheme::sobol}) {
    StudyOptions options;
    options.samples = 4'500;
    options.sampling = sampling;
    options.specification.critical_stiffness = 5500.0;
    options.index_samples = 16;
    options.tightening_samples = 100;
    options.worst = sampling == SamplingScheme::random;
    options.threads = 1;
    const std::vector<double> one = numbers_of(study(two_masses(), tolerances(), options));
    ASSERT_GT(one.size(), 50U);
    for (const std::size_t threads : {2U, 7U}) {
      options.threads = threads;
      EXPECT_EQ(numbers_of(study(two_masses(), tolerances(), options)), one) << threads;
    }
  }
}

// At the last edge too, which the stiffest units reach; where all are alike all of them do.
TEST(Study, HistogramSaysWhatShareReachesEachEdge) {
  StudyDistributions alike{{{"loop.delay", {.kind = Kind::discrete, .values = {1e-4}, .weights = {1.0}}}}};
  for (const StudyDistributions& distributions : {tolerances(), alike}) {
    StudyOptions options;
    options.samples = 500;
    options.index_samples = 0;
    options.worst = false;
    const StudyRun run(two_masses(), distributions, options);
    const std::vector<double> limits = run.answers(0).stiffness;
    const StiffnessHistogram histogram = study(two_masses(), distributions, options).histogram;
    ASSERT_EQ(histogram.yields.size(), histogram.edges.size());
    for (std::size_t i = 0; i < histogram.edges.size(); ++i) {
      const auto reaching = std::ranges::count_if(limits, [&](double limit) { return limit >= histogram.edges[i]; });
      EXPECT_EQ(histogram.yields[i], static_cast<double>(reaching) / 500.0) << i;
    }
  }
}

// A rigid device without delay: K_CR = b²(1-a)/(m(1-a) - abT), a = exp(-bT/m), which for a small bT/m is 2b/T to a part
// in bT/m (docs/theory.md, "Critical stiffness"). With b uniform, P(K_CR >= K) is linear in the b at which K_CR = K.
TEST(Study, YieldOfARigidDeviceIsInClosedForm) {
  const Device device(test::rigid_parameters());
  const auto limit = [](double b) {
    const double a = std::exp(-b * 1e-3 / 5.4);
    return b * b * -std::expm1(-b * 1e-3 / 5.4) / (5.4 * -std::expm1(-b * 1e-3 / 5.4) - a * b * 1e-3);
  };
  const StudyDistributions distributions{{{"body.body.damping", {.kind = Kind::uniform, .lower = 2.0, .upper = 4.0}}}};
  StudyOptions options;
  options.index_samples = 256;
  int covered = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    options.seed = seed;
    options.samples = 2000;
    options.worst = seed == 1;
    options.specification.critical_stiffness = limit(2.5);  // a quarter of the way: the yield is 3/4
    const Study result = study(device, distributions, options);
    covered += result.yield->lower <= 0.75 && 0.75 <= result.yield->upper ? 1 : 0;
    for (const QuantileEstimate& each : result.quantiles) {
      const double truth = limit(2.0 + 2.0 * each.probability);
      if (each.probability == 0.5) {
        EXPECT_NEAR(*each.value, truth, 200.0) << seed;
      }
    }
    if (seed > 1) continue;
    EXPECT_NEAR(result.worst->critical.stiffness / limit(2.0), 1.0, 1e-9);
    EXPECT_EQ(result.worst->values[0], 2.0 + 4.0 * 0x1p-54);
    EXPECT_NEAR(result.sobol_indices->front().total, 1.0, 0.02);
    // Half the spread about 3.5: from 2.75 to 3.75, all above 2.5.
    EXPECT_NEAR(result.tightening->front().yield_gain, 1.0 - result.yield->value, 0.05);
    EXPECT_EQ(result.tighten_first, std::optional<std::size_t>(0));
    ASSERT_EQ(result.clusters.size(), 1U);
    EXPECT_EQ(result.clusters[0].limited_by->mode, 0);
    // The normal score of the lowest quarter: mean -phi(q)/0.25 at q = -0.6745.
    EXPECT_NEAR(result.clusters[0].mean_scores[0], -1.2711, 0.1);
  }
  EXPECT_GE(covered, 34);  // of 40 at 95 %: fewer once in 10^4
}

TEST(Study, QuantileIntervalsHoldTheTruth) {
  // K_CR of a rigid device rises with b alone: the quantiles are those of b.
  const Device device(test::rigid_parameters());
  const StudyDistributions distributions{
      {{"body.body.damping", {.kind = Kind::normal, .centre = 3.5, .deviation = 0.2}}}};
  StudyOptions options;
  options.samples = 300;
  options.index_samples = options.tightening_samples = 0;
  options.worst = false;
  int held = 0;
  int asked = 0;
  for (std::uint64_t seed = 1; seed <= 60; ++seed) {
    options.seed = seed;
    const Study result = study(device, distributions, options);
    for (const QuantileEstimate& each : result.quantiles) {
      if (!each.lower || !each.upper) continue;
      DeviceParameters at = device.parameters();
      set_parameter(at, "body.body.damping", 3.5 + 0.2 * standard_normal_score(each.probability));
      const double truth = critical_stiffness(Device(at)).stiffness;
      ++asked;
      held += *each.lower <= truth && truth <= *each.upper ? 1 : 0;
    }
  }
  EXPECT_GT(asked, 200);
  EXPECT_GE(held, 0.93 * asked);
}

// Links that lose both stiffness and damping make no device: such units are listed, and count as failures.
TEST(Study, DropsNoUnitWithoutAnAnswer) {
  const Device device = two_masses();
  const StudyDistributions distributions{
      {{"link.stiffness", {.kind = Kind::discrete, .values = {0.0, 79.5e3}, .weights = {1.0, 9.0}}},
       {"link.damping", {.kind = Kind::discrete, .values = {0.0, 15.0}, .weights = {1.0, 9.0}}}}};
  StudyOptions options;
  options.samples = 1000;
  options.index_samples = options.tightening_samples = 0;
  options.specification.critical_stiffness = 1.0;
  const auto problem = find_problem(device, distributions);  // either alone may be 0
  ASSERT_FALSE(problem) << problem->key << problem->what;
  const Study result = study(device, distributions, options);
  EXPECT_GT(result.failed_count, 0U);
  EXPECT_EQ(result.failed.size(), result.failed_count);
  EXPECT_FALSE(result.failed.front().reason.empty());
  EXPECT_EQ(result.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_LE(result.yield->count + result.failed_count, result.samples);
}

TEST(Study, IsTrustedNoMoreThanItsDevice) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.uncertainty.emplace().warning = "a band that ends too early";
  StudyOptions options;
  options.samples = 100;
  options.index_samples = 16;
  const Study doubtful = study(Device(parameters), tolerances(), options);
  EXPECT_EQ(doubtful.trust.verdict, Trust::Verdict::doubtful);
  EXPECT_EQ(doubtful.doubtful, 0U);
  EXPECT_EQ(doubtful.worst->trust.verdict, Trust::Verdict::doubtful);
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  options.specification.critical_stiffness = 1.0;
  const Study refused = study(Device(parameters), tolerances(), options);
  EXPECT_TRUE(refused.trust.refused());
  EXPECT_FALSE(refused.yield);
  EXPECT_TRUE(refused.quantiles.empty());
  EXPECT_FALSE(refused.worst);
}

// What few samples cannot carry is not stated, and no error is 0 because nothing was seen.
TEST(Study, StatesNoNumberThatTheSamplesDoNotCarry) {
  for (const std::uint64_t samples : {1U, 10U, 100U, 3000U}) {
    StudyOptions options;
    options.samples = samples;
    options.specification.critical_stiffness = 1.0;
    options.index_samples = 16;
    const Study result = study(two_masses(), tolerances(), options);
    for (const QuantileEstimate& each : result.quantiles) {
      // X_(1) is above x_p with probability (1-p)^n, X_(n) below it with p^n.
      const auto n = static_cast<double>(samples);
      const bool carried = std::pow(1.0 - each.probability, n) <= 0.025 && std::pow(each.probability, n) <= 0.025;
      EXPECT_EQ(each.value.has_value(), carried) << samples << " " << each.probability;
      if (!each.value) continue;
      EXPECT_LE(*each.lower, *each.value);
      EXPECT_LE(*each.value, *each.upper);
    }
    EXPECT_EQ(result.reached_by_95_percent.has_value(), samples >= 59);
    EXPECT_EQ(result.yield->value, 1.0);
    for (const TighteningGain& each : *result.tightening) {
      EXPECT_EQ(each.yield_gain, 0.0);
      EXPECT_GT(each.error, 0.0);
    }
    EXPECT_FALSE(result.tighten_first);
    ASSERT_TRUE(result.worst);
    EXPECT_GE(result.worst->agreeing, 1U);
    EXPECT_LE(result.worst->agreeing, result.worst->descents);
    EXPECT_EQ(result.worst->trust.sound(), result.worst->agreeing > 1) << samples;
  }
}

// A number that the limit does not depend on has no share of its variance, and rounding is no variance.
TEST(Study, RoundingIsNoVariance) {
  const StudyDistributions distributions{
      {{"actuator.force_limit", {.kind = Kind::uniform, .lower = 1.0, .upper = 5.0}},
       {"sensor.resolution", {.kind = Kind::uniform, .lower = 1e-6, .upper = 1e-5}}}};
  StudyOptions options;
  options.samples = 100;
  options.index_samples = 64;
  const Study result = study(two_masses(), distributions, options);
  ASSERT_TRUE(result.sobol_indices);
  for (const SobolIndex& each : *result.sobol_indices) {
    EXPECT_EQ(each.first, 0.0);
    EXPECT_EQ(each.total, 0.0);
  }
}

TEST(Study, SaysWhichParameterChangesNoLimit) {
  StudyDistributions distributions = tolerances();
  distributions.parameters.push_back({"actuator.force_limit", {.kind = Kind::uniform, .lower = 1.0, .upper = 5.0}});
  StudyOptions options;
  options.samples = 100;
  options.index_samples = 16;
  const auto said = [&] {
    std::vector<std::string> keys;
    for (const Remark& each : study(two_masses(), distributions, options).remarks) {
      if (each.finding && each.finding->code == FindingCode::parameter_without_effect)
        keys.push_back(each.finding->key);
    }
    return keys;
  };
  EXPECT_EQ(said(), std::vector<std::string>{"actuator.force_limit"});
  distributions.parameters.pop_back();
  EXPECT_EQ(said(), std::vector<std::string>{});
}

// The unit that is worst for any user is no better than any sample, and than the one that is worst alone.
TEST(Study, FindsTheWorstUnitForAnyUser) {
  const StudyDistributions distributions{
      {{"link.stiffness", {.kind = Kind::normal, .centre = 79.5e3, .deviation = 6e3}},
       {"body.handle.damping", {.kind = Kind::uniform, .lower = 1.0, .upper = 5.0}}}};
  StudyOptions options;
  options.samples = 200;
  options.specification.any_user = 3000.0;
  options.index_samples = options.tightening_samples = 0;
  const Study result = study(two_masses(), distributions, options);
  ASSERT_TRUE(result.worst);
  ASSERT_TRUE(result.worst_any_user);
  EXPECT_LE(*result.worst_any_user->any_user, result.worst_any_user->sampled);
  EXPECT_LE(*result.worst_any_user->any_user, *result.worst->any_user * (1.0 + 1e-9));
  const Device device(result.worst_any_user->device);
  EXPECT_EQ(absolute_stability_limit(device, virtual_damper(device)).stiffness, *result.worst_any_user->any_user);
}

TEST(Study, RefusesOptionsByName) {
  const auto member = [](const StudyOptions& options, const Device& device) {
    const auto problem = find_problem(options, device, tolerances());
    return problem ? problem->member : "";
  };
  StudyOptions options;
  EXPECT_EQ(member(options, two_masses()), "");
  options.samples = 0;
  EXPECT_EQ(member(options, two_masses()), "samples");
  EXPECT_THROW((void)study(two_masses(), tolerances(), options), Error);
  options = {};
  options.specification.any_user = 100.0;
  EXPECT_EQ(member(options, Device(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1.0))),
            "specification.any_user");
  options = {};
  options.specification.critical_stiffness = NAN;
  EXPECT_EQ(member(options, two_masses()), "specification.critical_stiffness");
  options = {};
  options.threads = 100'000;
  EXPECT_EQ(member(options, two_masses()), "threads");
  options = {};
  options.index_samples = 15;
  EXPECT_EQ(member(options, two_masses()), "index_samples");
  options = {};
  options.samples = most_samples_in_memory + 1;
  EXPECT_EQ(member(options, two_masses()), "");  // a StudyRun may have more
  EXPECT_THROW((void)study(two_masses(), tolerances(), options), Error);
}

}  // namespace
}  // namespace zwidth
