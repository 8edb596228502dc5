#include "identification/response_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/identification/parameter_fit.hpp"
#include "zwidth/model/modal_form.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {
namespace {

/// With a delay and, where it is asked for, a lag beside it.
DeviceParameters late_lhifam(double lag) {
  DeviceParameters device = test::lhifam_parameters();
  device.loop.delay = 0.4e-3;
  device.actuator.time_constant = lag;
  return device;
}

double critical_stiffness_of(DeviceParameters device) {
  device.wall.damping = 0.0;
  return critical_stiffness(Device(std::move(device))).stiffness;
}

/// Lines of a device with complex normal noise of a known share of each.
FrequencyResponse noisy_lines(const DeviceParameters& parameters, double share, unsigned seed) {
  const Device device(parameters);
  const SampledPlant plant = sampled_plant(device);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, std::sqrt(0.5));
  FrequencyResponse made;
  made.sampling_period = device.loop().sampling_period;
  for (double hz = 0.5; hz < 300.0; hz *= 1.04) {
    const double w = 2.0 * std::numbers::pi * hz;
    const std::complex<double> exact = response(plant, w);
    const double deviation = share * std::abs(exact);
    made.points.push_back({.frequency = w,
                           .value = exact + deviation * std::complex<double>(normal(random), normal(random)),
                           .variance = deviation * deviation});
  }
  return made;
}

/// As if nobody knew its numbers: all off by half and more.
Device unknown_lhifam() {
  DeviceParameters structure = test::lhifam_parameters();
  for (Body& body : structure.bodies) {
    body.mass *= 1.5;
    body.damping *= 0.5;
  }
  structure.links[0].stiffness *= 0.6;
  structure.links[0].damping *= 2.0;
  return Device(std::move(structure));
}

MeasuredLimit limit_at(const DeviceParameters& parameters, double damping, double deviation) {
  const Device device(parameters);
  VirtualDamper damper = virtual_damper(device);
  damper.damping = damping;
  const std::optional<Crossover> limit = critical_stiffness(filtered_plant(device), damper).limit;
  MeasuredLimit made;
  made.stiffness = limit->stiffness;
  made.damping = damping;
  made.frequency_hz = limit->frequency / (2.0 * std::numbers::pi);
  made.stiffness_deviation = deviation;
  return made;
}

TEST(ResponseFit, TheIntervalHoldsTheTruth) {
  constexpr int records = 10;
  int holds = 0;
  for (int seed = 1; seed <= records; ++seed) {
    const DeviceParameters truth = late_lhifam(0.0);
    const FrequencyResponse lines = noisy_lines(truth, 0.01, static_cast<unsigned>(seed));
    const Device structure = unknown_lhifam();
    const auto found = fit_response({.structure = structure, .response = &lines, .frees_lateness = true});
    ASSERT_TRUE(found) << seed;
    EXPECT_EQ(found->last_change, 0.0) << seed;
    const double limit = critical_stiffness_of(truth);
    if (found->lower <= limit && limit <= found->upper) ++holds;
    EXPECT_LT(found->lower, found->value) << seed;
    EXPECT_LT(found->value, found->upper) << seed;
    EXPECT_NEAR(found->value, limit, 0.05 * limit) << seed;
    EXPECT_LT(found->upper / found->lower, 1.2) << seed;
    EXPECT_GT(found->omnibus.p, 1e-4) << seed;
    EXPECT_NEAR(found->device.bodies[0].mass, truth.bodies[0].mass, 0.02 * truth.bodies[0].mass) << seed;
  }
  EXPECT_GE(holds, 8);  // of 10 at 95 %: fewer in 1 % of such tests
}

TEST(ResponseFit, DeviationsAreThoseOfTheNoise) {
  constexpr int records = 12;
  double squares = 0.0;
  for (int seed = 1; seed <= records; ++seed) {
    const DeviceParameters truth = test::lhifam_parameters();
    const FrequencyResponse lines = noisy_lines(truth, 0.01, static_cast<unsigned>(seed));
    const Device structure = unknown_lhifam();
    const auto found = fit_response({.structure = structure, .response = &lines});
    ASSERT_TRUE(found) << seed;
    ASSERT_EQ(found->numbers[0].key, "body.motor.mass");
    const double left = std::log(found->numbers[0].value(found->x(0)) / truth.bodies[0].mass);
    squares += left * left / found->covariance(0, 0);
  }
  EXPECT_GT(squares, 3.1);  // chi-squared of 12: 0.5 % on either side
  EXPECT_LT(squares, 28.3);
}

TEST(ResponseFit, ALagIsPartOfIt) {
  const DeviceParameters truth = late_lhifam(1.5e-3);
  const FrequencyResponse lines = noisy_lines(truth, 0.003, 1);
  const Device structure = unknown_lhifam();
  const auto found = fit_response({.structure = structure, .response = &lines, .frees_lateness = true});
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->device.actuator.time_constant, 1.5e-3, 0.2e-3);
  EXPECT_NEAR(found->device.loop.delay, 0.4e-3, 0.2e-3);
  EXPECT_NEAR(found->value, critical_stiffness_of(truth), 0.03 * critical_stiffness_of(truth));
  ASSERT_EQ(found->rivals.size(), 2U);  // those of the catalogue that are linear
  EXPECT_EQ(found->rivals[0].code, "actuator_lag");
  EXPECT_EQ(found->rivals[1].keys, std::vector<std::string>{"body.handle.stiffness"});
}

// A table has no period and may have no variances: what is left over all lines is the noise.
TEST(ResponseFit, ATableWithoutVariancesHoldsTheTruth) {
  const DeviceParameters truth = late_lhifam(0.0);
  const ModalForm form = modal_form(Device(truth));
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, 0.01 * std::sqrt(0.5));
  FrequencyResponse table;
  for (double hz = 0.5; hz < 300.0; hz *= 1.04) {
    const double w = 2.0 * std::numbers::pi * hz;
    table.points.push_back({.frequency = w,
                            .value = response(form, w) * std::polar(1.0, -w * truth.loop.delay) *
                                     (1.0 + std::complex<double>(normal(random), normal(random)))});
  }
  const Device structure = unknown_lhifam();
  const auto found = fit_response({.structure = structure, .response = &table, .frees_lateness = true});
  ASSERT_TRUE(found);
  EXPECT_LE(found->lower, critical_stiffness_of(truth));
  EXPECT_GE(found->upper, critical_stiffness_of(truth));
  EXPECT_LT(found->upper / found->lower, 1.2);
  EXPECT_GT(found->omnibus.p, 1e-3);
}

TEST(ResponseFit, ALimitBesideLinesNarrowsTheInterval) {
  const DeviceParameters truth = test::lhifam_parameters();
  const FrequencyResponse lines = noisy_lines(truth, 0.05, 1);
  const std::vector<MeasuredLimit> limits = {limit_at(truth, 0.0, 0.01)};
  const Device structure = unknown_lhifam();
  const auto without = fit_response({.structure = structure, .response = &lines});
  const auto with = fit_response({.structure = structure, .response = &lines, .limits = limits});
  ASSERT_TRUE(without);
  ASSERT_TRUE(with);
  EXPECT_LT(std::log(with->upper / with->lower), 0.5 * std::log(without->upper / without->lower));
  EXPECT_LE(with->lower, critical_stiffness_of(truth));
  EXPECT_GE(with->upper, critical_stiffness_of(truth));
  EXPECT_GT(with->omnibus.p, 1e-3);
}

// The paper's locked handle: of its mass and damping the lines tell nothing.
TEST(ResponseFit, WhatIsGivenIsAsOpenAsTheFileSays) {
  const DeviceParameters truth = test::lhifam_parameters();
  DeviceParameters locked = locked_device(Device(truth), {1}).parameters();
  const FrequencyResponse lines = noisy_lines(locked, 0.003, 1);
  DeviceParameters file = truth;
  const auto width = [&] {
    const Device structure(file);
    const auto found = fit_response({.structure = structure,
                                     .response = &lines,
                                     .free = {"link.stiffness", "link.damping"},
                                     .locked = {"handle"},
                                     .known = true});
    return found ? std::log(found->upper / found->lower) : 0.0;
  };
  const double exact = width();
  file.uncertainty =
      Uncertainty{.parameters = {"body.handle.damping"}, .covariance = {{std::pow(0.1 * file.bodies[1].damping, 2)}}};
  EXPECT_GT(exact, 0.0);
  EXPECT_LT(exact, 0.02);
  EXPECT_GT(width(), 0.1);
}

TEST(ResponseFit, ABodyThatIsMissingStandsOut) {
  const DeviceParameters truth = test::lhifam_parameters();
  const FrequencyResponse lines = noisy_lines(truth, 0.01, 1);
  DeviceParameters rigid = truth;
  rigid.bodies = {{"all", 5.0, 3.0}};
  rigid.links.clear();
  rigid.loop.actuated = rigid.loop.sensed = rigid.loop.held = 0;
  const Device structure(rigid);
  const auto found = fit_response({.structure = structure, .response = &lines});
  ASSERT_TRUE(found);
  EXPECT_LT(found->omnibus.p, 1e-6);
}

TEST(ResponseFit, LimitsAloneNarrowAFile) {
  const DeviceParameters truth = test::lhifam_parameters();
  std::vector<MeasuredLimit> coarse = {limit_at(truth, 0.0, 10.0)};
  coarse[0].frequency_hz.reset();
  const std::vector<MeasuredLimit> fine = {limit_at(truth, 0.0, 0.02), limit_at(truth, 5.0, 0.02)};
  DeviceParameters file = truth;
  file.bodies[1].damping *= 1.2;  // within what a file is believed to
  file.links[0].stiffness *= 0.9;
  const Device structure(file);
  const auto wide = fit_response({.structure = structure, .limits = coarse, .known = true});
  const auto narrow = fit_response({.structure = structure, .limits = fine, .known = true});
  ASSERT_TRUE(wide);
  ASSERT_TRUE(narrow);
  EXPECT_GT(wide->upper / wide->lower, 1.1);
  EXPECT_LT(std::log(narrow->upper / narrow->lower), 0.5 * std::log(wide->upper / wide->lower));
  EXPECT_LE(narrow->lower, critical_stiffness_of(truth));
  EXPECT_GE(narrow->upper, critical_stiffness_of(truth));
  EXPECT_GT(narrow->omnibus.p, 0.01);
  EXPECT_TRUE(narrow->rivals.empty());
}

TEST(ResponseFit, TheUncertaintyOfAFileIsThePriorOfLimits) {
  DeviceParameters file = test::lhifam_parameters();
  const double damping = file.bodies[1].damping;
  file.uncertainty = Uncertainty{.parameters = {"body.handle.damping"}, .covariance = {{std::pow(0.1 * damping, 2)}}};
  const Device structure(file);
  std::vector<MeasuredLimit> far = {limit_at(file, 0.0, 10.0)};
  far[0].frequency_hz.reset();
  const auto found = fit_response({.structure = structure, .limits = far, .known = true});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->numbers.size(), 1U);
  const double deviation = found->numbers[0].slope(found->x(0)) * std::sqrt(found->covariance(0, 0));
  EXPECT_NEAR(deviation, 0.1 * damping, 0.01 * damping);
}

TEST(ResponseFit, OfALagAloneLimitsTellAsOfADelay) {
  DeviceParameters truth = test::lhifam_parameters();
  truth.actuator.time_constant = 1e-3;
  const Device structure(truth);
  const std::vector<MeasuredLimit> limits = {limit_at(truth, 0.0, 0.02)};
  const auto found = fit_response({.structure = structure, .limits = limits, .known = true});
  ASSERT_TRUE(found);
  EXPECT_EQ(std::ranges::count(found->numbers, "actuator.time_constant", &Number::key), 0);
  EXPECT_EQ(std::ranges::count(found->numbers, "loop.delay", &Number::key), 1);
  EXPECT_NEAR(found->device.loop.delay + found->device.actuator.time_constant, 1e-3, 0.2e-3);
  EXPECT_LE(found->lower, critical_stiffness_of(truth));
  EXPECT_GE(found->upper, critical_stiffness_of(truth));
}

// A delay and a lag that share a known sum: neither is known, the limit is.
TEST(ResponseFit, AFileKeepsTheSumOfDelayAndLag) {
  DeviceParameters file = late_lhifam(0.6e-3);
  const double open = std::pow(0.2e-3, 2);
  const double shared = -0.99 * open;
  file.uncertainty = Uncertainty{.parameters = {"loop.delay", "actuator.time_constant"},
                                 .covariance = {{open, shared}, {shared, open}}};
  std::vector<MeasuredLimit> far = {limit_at(file, 0.0, 10.0)};
  far[0].frequency_hz.reset();
  const Device structure(file);
  const auto found = fit_response({.structure = structure, .limits = far, .known = true});
  ASSERT_TRUE(found);
  ASSERT_EQ(found->numbers[0].key, "loop.delay");  // the sum of both
  EXPECT_NEAR(found->numbers[0].slope(0.0) * std::sqrt(found->covariance(0, 0)), std::sqrt(0.02 * open), 1e-7);
  EXPECT_LT(found->upper / found->lower, 1.2);
}

TEST(ResponseFit, RefusesANumberThatTheFileLacks) {
  const Device structure(test::lhifam_parameters());
  const std::vector<MeasuredLimit> limits = {limit_at(structure.parameters(), 0.0, 0.05)};
  EXPECT_THROW(
      (void)fit_response({.structure = structure, .limits = limits, .free = {"body.nobody.mass"}, .known = true}),
      Error);
}

TEST(ResponseFit, ALimitThatContradictsAFileStandsOut) {
  const DeviceParameters truth = test::lhifam_parameters();
  DeviceParameters file = truth;
  file.uncertainty =
      Uncertainty{.parameters = {"body.handle.damping"}, .covariance = {{std::pow(0.01 * file.bodies[1].damping, 2)}}};
  std::vector<MeasuredLimit> limits = {limit_at(truth, 0.0, 0.05)};
  limits[0].stiffness *= 2.0;
  limits[0].frequency_hz.reset();
  const Device structure(file);
  const auto found = fit_response({.structure = structure, .limits = limits, .known = true});
  ASSERT_TRUE(found);
  EXPECT_LT(found->omnibus.p, 1e-6);
}

TEST(ResponseFit, NumbersOfNobodySayNothingOfALimit) {
  const Device structure = unknown_lhifam();
  const std::vector<MeasuredLimit> limits = {limit_at(test::lhifam_parameters(), 0.0, 0.05)};
  EXPECT_FALSE(fit_response({.structure = structure, .limits = limits}));
  EXPECT_FALSE(fit_response({.structure = structure, .known = true}));
}

}  // namespace
}  // namespace zwidth::internal
