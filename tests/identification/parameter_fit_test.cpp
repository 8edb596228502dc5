#include "zwidth/identification/parameter_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "identification/initial_fit/missed_mode.hpp"
#include "identification/synthetic_response.hpp"
#include "lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/io/device_file.hpp"
#include "zwidth/model/parameter.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth {
namespace {

using test::synthetic_response;
using test::SyntheticNoise;

/// The same bodies and links, all numbers 1: nothing that a fit could lean on.
DeviceParameters without_numbers(DeviceParameters device) {
  for (Body& body : device.bodies) body.mass = body.damping = 1.0;
  for (Link& link : device.links) link.stiffness = link.damping = 1.0;
  return device;
}

DeviceParameters three_body() {
  DeviceParameters device = test::lhifam_parameters();
  device.name = "three bodies";
  device.bodies = {{"motor", 0.3, 0.5, 0.0, 0.0}, {"arm", 0.8, 0.7, 0.0, 0.0}, {"handle", 0.4, 0.6, 0.0, 0.0}};
  device.links = {{0, 1, 80e3, 10.0}, {1, 2, 30e3, 5.0}};
  device.loop.held = 2;
  return device;
}

double truth(const DeviceParameters& device, const std::string& key) { return *parameter(device, key); }

void expect_recovered(const ParameterFit& fit, const DeviceParameters& device, double tolerance) {
  for (const ParameterEstimate& estimate : fit.estimates) {
    EXPECT_TRUE(estimate.identifiable) << estimate.key;
    const double expected = truth(device, estimate.key);
    EXPECT_NEAR(estimate.value, expected, tolerance * expected) << estimate.key;
  }
}

struct Case {
  std::string name;
  DeviceParameters device;
};

class FreeDevice : public testing::TestWithParam<Case> {};

// Without noise only rounding is left: of the finite differences in the search, not of the model.
TEST_P(FreeDevice, IsRecoveredWithoutNoiseAndWithoutAGuess) {
  const DeviceParameters& device = GetParam().device;
  DeviceParameters structure = without_numbers(device);
  if (device.loop.delay > 0.0) structure.loop.delay = 1e-3;
  if (device.actuator.time_constant > 0.0) structure.actuator.time_constant = 1e-3;
  const ParameterFit fit = fit_parameters(Device(structure), synthetic_response(Device(device), 1.0, 400.0, 400, {}));
  expect_recovered(fit, device, 1e-5);
  EXPECT_NEAR(critical_stiffness(fit.device).stiffness / critical_stiffness(Device(device)).stiffness, 1.0, 1e-4);
}

// With noise every parameter lies within 4.5 of its own standard deviations (1 in 70 000 per parameter).
TEST_P(FreeDevice, LiesWithinItsIntervals) {
  const DeviceParameters& device = GetParam().device;
  DeviceParameters structure = without_numbers(device);
  if (device.loop.delay > 0.0) structure.loop.delay = 1e-3;
  if (device.actuator.time_constant > 0.0) structure.actuator.time_constant = 1e-3;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const FrequencyResponse measured = synthetic_response(Device(device), 1.0, 400.0, 400, {0.01, seed});
    const ParameterFit fit = fit_parameters(Device(structure), measured);
    ASSERT_TRUE(fit.misfit.has_value());
    EXPECT_NEAR(*fit.misfit, 1.0, 0.1);
    EXPECT_LT(fit.model_error, 0.005);
    for (const ParameterEstimate& estimate : fit.estimates) {
      ASSERT_TRUE(estimate.standard_deviation.has_value()) << estimate.key;
      EXPECT_LT(std::abs(estimate.value - truth(device, estimate.key)), 4.5 * *estimate.standard_deviation)
          << estimate.key;
    }
  }
}

DeviceParameters with_delay_and_lag(DeviceParameters device) {
  device.loop.delay = 0.4e-3;
  device.actuator.time_constant = 0.5e-3;
  return device;
}

DeviceParameters equal_masses() {
  DeviceParameters device = test::lhifam_parameters();
  device.bodies = {{"motor", 0.3, 0.6, 0.0, 0.0}, {"handle", 0.4, 0.9, 0.0, 0.0}};
  device.links = {{0, 1, 30e3, 3.0}};
  return device;
}

INSTANTIATE_TEST_SUITE_P(All, FreeDevice,
                         testing::Values(Case{"rigid", test::rigid_parameters()},
                                         Case{"lhifam", test::lhifam_parameters()},
                                         Case{"equal_masses", equal_masses()},
                                         Case{"delay_and_lag", with_delay_and_lag(equal_masses())},
                                         Case{"three_bodies", three_body()}),
                         [](const auto& instance) { return instance.param.name; });

// The intervals hold the truth as often as they say; normal and binomial limits of 60 trials: 0.95 +- 3.2 sigma.
TEST(ParameterFit, IntervalsHoldTheTruth) {
  constexpr int trials = 60;
  std::map<std::string, int> inside;
  const DeviceParameters device = equal_masses();
  ParameterFitOptions options;
  options.start = ParameterFitOptions::Start::from_structure;
  for (int trial = 1; trial <= trials; ++trial) {
    const auto seed = static_cast<std::uint64_t>(trial);
    const FrequencyResponse measured = synthetic_response(Device(device), 1.0, 300.0, 300, {0.02, seed});
    const ParameterFit fit = fit_parameters(Device(device), measured, options);
    for (const ParameterEstimate& estimate : fit.estimates) {
      const double expected = truth(device, estimate.key);
      if (estimate.lower && *estimate.lower <= expected && expected <= *estimate.upper) ++inside[estimate.key];
    }
  }
  ASSERT_EQ(inside.size(), 6U);
  for (const auto& [key, count] : inside) EXPECT_GE(count, 0.86 * trials) << key;
}

// Locked at the handle the motor feels b_m + b_c only; everything behind the handle does nothing.
TEST(ParameterFit, NamesWhatALockedDeviceDoesNotShow) {
  const DeviceParameters device = test::lhifam_parameters();
  ParameterFitOptions options;
  options.locked = {"handle"};
  options.free = {"body.motor.mass", "body.motor.damping", "link.stiffness", "link.damping", "body.handle.mass"};
  const Device locked = locked_device(Device(device), {1});
  DeviceParameters structure = device;
  structure.bodies[0].mass = 1.0;
  structure.links[0] = {0, 1, 1e3, 5.0};
  const ParameterFit fit =
      fit_parameters(Device(structure), synthetic_response(locked, 10.0, 200.0, 200, {0.01, 3}), options);
  ASSERT_EQ(fit.unidentifiable.size(), 2U);
  EXPECT_EQ(fit.unidentifiable[0].parameters, std::vector<std::string>{"body.handle.mass"});
  EXPECT_EQ(fit.unidentifiable[1].parameters, (std::vector<std::string>{"body.motor.damping", "link.0.damping"}));
  const auto estimate = [&](const std::string& key) {
    return *std::ranges::find(fit.estimates, key, &ParameterEstimate::key);
  };
  EXPECT_TRUE(estimate("body.motor.mass").identifiable);
  EXPECT_NEAR(estimate("body.motor.mass").value, 0.3, 0.003);
  EXPECT_NEAR(estimate("link.0.stiffness").value, 79.5e3, 300.0);
  EXPECT_FALSE(estimate("body.motor.damping").identifiable);
  EXPECT_FALSE(estimate("link.0.damping").standard_deviation.has_value());
  EXPECT_NEAR(estimate("body.motor.damping").value + estimate("link.0.damping").value, 15.1, 0.2);
  EXPECT_NEAR(estimate("body.handle.mass").value, 5.1, 1e-6);  // as in the structure
  // The two dampings are open, against each other, as far as their sum is known.
  const Uncertainty& uncertainty = *fit.device.parameters().uncertainty;
  ASSERT_EQ(uncertainty.parameters,
            (std::vector<std::string>{"body.motor.mass", "body.motor.damping", "link.0.stiffness", "link.0.damping"}));
  const auto& covariance = uncertainty.covariance;
  const double deviation_of_sum = std::sqrt(covariance[1][1] + covariance[3][3] + 2.0 * covariance[1][3]);
  EXPECT_GT(std::sqrt(covariance[1][1]), 0.5 * 15.1);
  EXPECT_NEAR(estimate("body.motor.damping").value + estimate("link.0.damping").value, 15.1, 4.0 * deviation_of_sum);
  EXPECT_LT(deviation_of_sum, 0.1);
  EXPECT_TRUE(std::ranges::any_of(fit.remarks, [](const Remark& remark) {
    return remark.what.find("body.motor.damping, link.0.damping") != std::string::npos;
  }));
}

// Across an undamped link only k/(m_1 m_2) and k (1/m_1 + 1/m_2) show: two numbers of three.
TEST(ParameterFit, NamesTheMassesThatAcrossALinkOnlyShowTogether) {
  DeviceParameters device = test::handle_sensed(equal_masses());
  device.bodies[0].damping = device.bodies[1].damping = device.links[0].damping = 0.0;
  ParameterFitOptions options;
  options.free = {"body.motor.mass", "body.handle.mass", "link.stiffness"};
  const ParameterFit fit =
      fit_parameters(Device(device), synthetic_response(Device(device), 5.0, 200.0, 100, {0.01, 1}), options);
  ASSERT_EQ(fit.unidentifiable.size(), 1U);
  EXPECT_EQ(fit.unidentifiable[0].parameters.size(), 3U);
  ASSERT_TRUE(fit.device.parameters().uncertainty);
  EXPECT_EQ(fit.device.parameters().uncertainty->parameters.size(), 3U);
}

TEST(ParameterFit, ADampingOfZeroHasAOneSidedInterval) {
  DeviceParameters device = equal_masses();
  device.bodies[0].damping = 0.0;
  int at_zero = 0;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ParameterFit fit = fit_parameters(Device(without_numbers(device)),
                                            synthetic_response(Device(device), 1.0, 300.0, 300, {0.02, seed}));
    const ParameterEstimate& damping = fit.estimates[1];
    ASSERT_EQ(damping.key, "body.motor.damping");
    EXPECT_LT(damping.value, 4.0 * *damping.standard_deviation);
    if (damping.value > 0.0) continue;
    ++at_zero;
    EXPECT_EQ(*damping.lower, 0.0);
    EXPECT_NEAR(*damping.upper, 1.96 * *damping.standard_deviation, 1e-4 * *damping.upper);
  }
  EXPECT_GT(at_zero, 0);  // where the noise would have it negative
}

// The data of three bodies on a structure of two: it takes one of the modes, and what is left shows the other.
TEST(ParameterFit, WhatIsLeftShowsAModeThatWasPassedOver) {
  const FrequencyResponse measured = synthetic_response(Device(three_body()), 5.0, 200.0, 391, {0.005, 1});
  const ParameterFit fit = fit_parameters(Device(without_numbers(test::lhifam_parameters())), measured);
  const std::vector<Mode> modes = modal_form(Device(three_body())).modes;
  const double found = modal_form(fit.device).modes.at(0).frequency;
  const bool has_first = std::abs(found - modes[0].frequency) < std::abs(found - modes[1].frequency);
  const double passed_over = modes[has_first ? 1 : 0].frequency;
  const std::optional<double> missed = internal::missed_mode(fit.residuals, measured, {found});
  ASSERT_TRUE(missed);
  EXPECT_NEAR(*missed, passed_over, 0.01 * passed_over);
}

TEST(ParameterFit, ARightStructureLeavesNoMode) {
  const FrequencyResponse measured = synthetic_response(Device(equal_masses()), 5.0, 200.0, 391, {0.01, 1});
  const ParameterFit fit = fit_parameters(Device(without_numbers(equal_masses())), measured);
  EXPECT_FALSE(internal::missed_mode(fit.residuals, measured, {modal_form(fit.device).modes.at(0).frequency}));
  EXPECT_TRUE(fit.remarks.empty());
}

// The paper's experiment: the motor on its cable to a held handle, 5 N swept from 10 to 200 Hz in 20 s. The structure knows masses
// and bearing, and is far off at the cable.
TEST(ParameterFit, FindsTheCableOfTheLockedDevice) {
  const DeviceParameters truth = test::lhifam_parameters();
  ExcitationOptions sweep;
  sweep.amplitude = 5.0;
  sweep.lowest_hz = 10.0;
  const std::vector<double> force = excite(sweep).samples;
  const auto position = test::synthetic_position(locked_device(Device(truth), {1}), force, {0.025, 3.14e-6, 1});
  DeviceParameters structure = truth;
  structure.links[0] = {0, 1, 10e3, 1.0};
  const ParameterFit fit = fit_parameters(Device(structure), frequency_response(force, position, 1e-3),
                                          {.free = {"link.stiffness", "link.damping"}, .locked = {"handle"}});
  EXPECT_NEAR(fit.estimates.at(0).value, 79.5e3, 0.01 * 79.5e3);
  EXPECT_NEAR(fit.estimates.at(1).value, 15.0, 0.05 * 15.0);
  EXPECT_EQ(fit.device.bodies().size(), 2U);  // free again
  EXPECT_NEAR(critical_stiffness(fit.device).stiffness, 8848.709, 5.0);
}

// A few lines that are far off (a mains hum) move the result by less than its standard deviation.
TEST(ParameterFit, OutliersCountLittle) {
  FrequencyResponse measured = synthetic_response(Device(equal_masses()), 1.0, 300.0, 300, {0.01, 1});
  const ParameterFit clean = fit_parameters(Device(equal_masses()), measured);
  for (const std::size_t line : {49U, 50U, 149U}) measured.points[line].value *= std::complex<double>(1.0, 1.5);
  const ParameterFit spoilt = fit_parameters(Device(equal_masses()), measured);
  for (std::size_t i = 0; i < clean.estimates.size(); ++i) {
    EXPECT_LT(std::abs(spoilt.estimates[i].value - clean.estimates[i].value), *clean.estimates[i].standard_deviation)
        << clean.estimates[i].key;
  }
}

// A table has no variances and no period: weights are relative, the noise is judged from the residuals.
TEST(ParameterFit, TakesAContinuousTableWithoutVariances) {
  const DeviceParameters device = test::with_delay(equal_masses(), 0.3e-3);
  const ModalForm form = modal_form(Device(device));
  FrequencyResponse table;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, 0.01 * std::sqrt(0.5));
  for (double hertz = 2.0; hertz < 300.0; hertz += 1.0) {
    ResponsePoint point;
    point.frequency = 2.0 * std::numbers::pi * hertz;
    point.value = response(form, point.frequency) * std::polar(1.0, -point.frequency * 0.3e-3) *
                  (1.0 + std::complex<double>(normal(random), normal(random)));
    table.points.push_back(point);
  }
  DeviceParameters structure = without_numbers(device);
  structure.loop.delay = 1e-3;
  const ParameterFit fit = fit_parameters(Device(structure), table);
  EXPECT_FALSE(fit.misfit.has_value());
  EXPECT_NEAR(fit.model_error, 0.01, 0.002);
  for (const ParameterEstimate& estimate : fit.estimates) {
    EXPECT_LT(std::abs(estimate.value - truth(device, estimate.key)), 4.5 * *estimate.standard_deviation)
        << estimate.key;
  }
}

TEST(ParameterFit, FittedDeviceGoesThroughAFile) {
  const FrequencyResponse measured = synthetic_response(Device(equal_masses()), 1.0, 300.0, 300, {0.01, 1});
  const ParameterFit fit = fit_parameters(Device(equal_masses()), measured);
  const auto again = parse_device(write_device(fit.device.parameters()), "fitted.toml");
  ASSERT_TRUE(again.has_value()) << again.error().str();
  EXPECT_EQ(again->parameters().uncertainty->covariance, fit.device.parameters().uncertainty->covariance);
  EXPECT_TRUE(analyze(*again).interval.has_value());
}

TEST(ParameterFit, RefusesWhatItCannotFit) {
  const Device device(equal_masses());
  const FrequencyResponse measured = synthetic_response(device, 1.0, 300.0, 50, {0.01, 1});
  const auto refused = [&](ParameterFitOptions options) {
    EXPECT_THROW((void)fit_parameters(device, measured, options), Error);
  };
  refused({.free = {"link.stifness"}});
  refused({.free = {"wall.stiffness"}});
  refused({.free = {"body.motor.coulomb"}});
  refused({.free = {"link.stiffness", "link.0.stiffness"}});
  refused({.locked = {"motor"}});
  refused({.locked = {"nobody"}});
  refused({.lowest = 2.0 * std::numbers::pi * 19.0, .highest = 2.0 * std::numbers::pi * 20.0});
  DeviceParameters long_chain = equal_masses();
  for (std::size_t i = 2; i < 12; ++i) {
    long_chain.bodies.push_back({"body " + std::to_string(i), 1.0, 1.0, 0.0, 0.0});
    long_chain.links.push_back({i - 1, i, 1e4, 1.0});
  }
  EXPECT_THROW((void)fit_parameters(Device(long_chain), measured), Error);  // 46 parameters, 50 points
  const Device transfer(test::transfer_function_parameters({1.0}, {1.0, 1.0}, 1e-3));
  EXPECT_THROW((void)fit_parameters(transfer, measured), Error);
  FrequencyResponse bad = measured;
  bad.points[3].value = std::nan("");
  EXPECT_THROW((void)fit_parameters(device, bad), Error);
}

// No wall acts in an experiment; at the record's rate its filters may even be impossible.
TEST(ParameterFit, TheFiltersOfTheWallAreLeftOut) {
  DeviceParameters slow = test::lhifam_parameters();
  slow.loop.sampling_period = 4e-3;
  const FrequencyResponse measured = synthetic_response(Device(slow), 1.0, 120.0, 200, {});
  const DeviceParameters bare = without_numbers(test::lhifam_parameters());
  DeviceParameters filtered = bare;
  filtered.wall.filters = {{.kind = WallFilter::Kind::low_pass, .frequency_hz = 300.0}};  // above 125 Hz
  const ParameterFit expected = fit_parameters(Device(bare), measured);
  const ParameterFit fit = fit_parameters(Device(filtered), measured);
  ASSERT_EQ(fit.estimates.size(), expected.estimates.size());
  for (std::size_t i = 0; i < fit.estimates.size(); ++i) {
    EXPECT_EQ(fit.estimates[i].key, expected.estimates[i].key);
    EXPECT_EQ(fit.estimates[i].value, expected.estimates[i].value);
  }
  EXPECT_EQ(fit.device.parameters().wall.filters, filtered.wall.filters);  // the device keeps them
}

TEST(ParameterFit, AllMeansWhatIsNotLocked) {
  const Device device(with_delay_and_lag(test::lhifam_parameters()));
  EXPECT_EQ(fittable_parameters(device, {"handle"}),
            (std::vector<std::string>{"body.motor.mass", "body.motor.damping", "link.0.stiffness", "link.0.damping",
                                      "loop.delay", "actuator.time_constant"}));
  EXPECT_EQ(fittable_parameters(Device(test::lhifam_parameters())).size(), 6U);
}

TEST(ParameterFit, AllStandsForWhatEmptyMeans) {
  const Device device(test::lhifam_parameters());
  const std::vector<std::string> all = fittable_parameters(device);
  EXPECT_EQ(free_parameters(device, {}), all);
  EXPECT_EQ(free_parameters(device, {"all", "link.stiffness"}), all);
  EXPECT_EQ(free_parameters(device, {"loop.delay", "all"}).back(), "loop.delay");
  EXPECT_EQ(free_parameters(device, {"link.stiffness"}), std::vector<std::string>{"link.0.stiffness"});
  EXPECT_TRUE(frees_all({"loop.delay", "all"}));
  EXPECT_FALSE(frees_all({"loop.delay"}));
}

}  // namespace
}  // namespace zwidth
