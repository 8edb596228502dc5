// Devices whose poles crowd: separate terms cancel there by 1e14 and more. Each answer is held against a count of the
// closed loop's poles in 200-digit arithmetic just below and just above it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "exact_closed_loop.hpp"
#include "zwidth/design/design_target.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

Device transfer_function_device(TransferFunction g) {
  DeviceParameters parameters;
  parameters.name = "crowded";
  parameters.transfer_function = std::move(g);
  parameters.loop.sampling_period = 1e-3;
  return Device(parameters);
}

// 1 / (factor)^count, as the coefficients that a device file would hold.
std::vector<double> power(const std::vector<double>& factor, int count) {
  std::vector<double> result{1.0};
  for (int i = 0; i < count; ++i) {
    std::vector<double> product(result.size() + factor.size() - 1, 0.0);
    for (std::size_t a = 0; a < result.size(); ++a)
      for (std::size_t b = 0; b < factor.size(); ++b) product[a + b] += result[a] * factor[b];
    result = product;
  }
  return result;
}

double confirmed_stiffness(const Device& device) {
  const CriticalStiffness result = critical_stiffness(filtered_plant(device));
  EXPECT_EQ(result.status, StiffnessStatus::finite);
  const test::ExactClosedLoop loop(device);
  for (const double share : {1.0 - 1e-9, 0.9, 0.5, 0.1, 1e-3}) {
    EXPECT_EQ(loop.poles_outside(share * result.stiffness), 0) << share;
  }
  EXPECT_GT(loop.poles_outside((1.0 + 1e-9) * result.stiffness), 0);
  return result.stiffness;
}

// Poles within 20 % of 1 rad/s. Taken apart they gave 3294.6.
TEST(CrowdedPoles, EightRealPoles) {
  const Device device =
      transfer_function_device({{1.36913965073807},
                                {1, 8.32105676757705, 30.292492317337096, 63.01638106302106, 81.93168896436515,
                                 68.17581053664675, 35.45591592994482, 10.536807324628331, 1.3699584802328493}});
  EXPECT_NEAR(confirmed_stiffness(device), 1.885, 1e-3);
}

// 1.074 once. Without a hold eight lags bear 1/cos(pi/8)^8 = 1.885; half a sample of delay takes the rest.
TEST(CrowdedPoles, EightEqualLags) {
  const std::vector<double> denominator = power({1.0, 314.16}, 8);
  EXPECT_NEAR(confirmed_stiffness(transfer_function_device({{denominator.back()}, denominator})), 1.837, 1e-3);
}

TEST(CrowdedPoles, TwelveAndTwentyFourEqualLags) {
  for (const int count : {12, 24}) {
    const std::vector<double> denominator = power({1.0, 10.0}, count);
    confirmed_stiffness(transfer_function_device({{denominator.back()}, denominator}));
  }
}

TEST(CrowdedPoles, FourEqualPairs) {
  for (const double ratio : {0.01, 0.1, 0.7}) {
    const std::vector<double> denominator = power({1.0, 2.0 * ratio * 60.0, 3600.0}, 4);
    confirmed_stiffness(transfer_function_device({{denominator.back()}, denominator}));
  }
}

// More equal poles than one term holds: an error that says so, and no number.
TEST(CrowdedPoles, MoreThanOneTermHoldsIsRefused) {
  const std::vector<double> denominator = power({1.0, 1.0}, 30);
  try {
    static_cast<void>(critical_stiffness(filtered_plant(transfer_function_device({{1.0}, denominator}))));
    FAIL() << "gave a number";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::did_not_converge);
    EXPECT_NE(std::string(error.what()).find("lower the order"), std::string::npos) << error.what();
  }
}

// Sensed at the far end of a chain, terms cancel to their 30th digit: refused until the sum of terms was asked there.
TEST(CrowdedPoles, AChainWhoseTermsCancelIsAnswered) {
  for (const std::size_t count : {13U, 15U}) {
    DeviceParameters parameters;
    parameters.name = "chain";
    for (std::size_t i = 0; i < count; ++i) {
      parameters.bodies.push_back({"body" + std::to_string(i), 0.1, 0.1, 0.0, 0.0});
      if (i > 0) parameters.links.push_back({i - 1, i, 2e4, 1.0});
    }
    parameters.loop.sampling_period = 1e-3;
    parameters.loop.sensed = parameters.loop.held = count - 1;
    const Device device(parameters);
    const CriticalStiffness result = critical_stiffness(device);
    EXPECT_TRUE(result.trust.sound()) << count;
    ASSERT_EQ(result.status, StiffnessStatus::finite) << count;
    const test::ExactClosedLoop loop(device);
    EXPECT_EQ(loop.poles_outside((1.0 - 1e-9) * result.stiffness), 0) << count;
    EXPECT_EQ(loop.poles_outside((1.0 + 1e-9) * result.stiffness), 2) << count;
  }
}

// Refusal travels: no number, and why.
TEST(CrowdedPoles, ARefusedDeviceIsRefusedThroughout) {
  DeviceParameters parameters;
  parameters.name = "refused";
  parameters.bodies = {{"body", 1.0, 1.0, 0.0, 0.0}};
  parameters.loop.sampling_period = 1e-3;
  parameters.uncertainty = Uncertainty{};
  parameters.uncertainty->verdict = Trust::Verdict::refused;
  parameters.uncertainty->reasons = {"measured wrongly"};
  const Device device(parameters);
  const Analysis analysis = analyze(device, {});
  EXPECT_TRUE(analysis.trust.refused());
  EXPECT_EQ(analysis.critical.status, StiffnessStatus::refused);
  EXPECT_TRUE(std::isnan(analysis.critical.stiffness));
  EXPECT_EQ(verdict_on_wall(analysis), WallVerdict::unsure);
  EXPECT_TRUE(design_targets(device, {.stiffness = 1000.0}).trust.refused());
}

TEST(CrowdedPoles, FourNearlyIdenticalBodies) {
  for (const double spread : {0.0, 1e-8, 1e-5, 1e-3}) {
    for (const std::size_t sensed : {0u, 1u, 3u}) {
      DeviceParameters parameters;
      parameters.name = "alike";
      for (std::size_t i = 0; i < 4; ++i) {
        parameters.bodies.push_back(
            {"body" + std::to_string(i), 0.2 * (1.0 + spread * static_cast<double>(i * i)), 0.3, 800.0, 0.0});
        if (i > 0) parameters.links.push_back({i - 1, i, 0.05, 0.0});
      }
      parameters.loop.sampling_period = 1e-3;
      parameters.loop.sensed = sensed;
      parameters.loop.held = 3;
      confirmed_stiffness(Device(parameters));
    }
  }
}

// Thirty bodies, sensed at the far end: the response falls to 1e-36 of its terms. Of the crossovers below 200 MN/m the
// eight from 34.8 kN/m on were missed.
TEST(CrowdedPoles, EveryCrossoverOfALongChain) {
  DeviceParameters parameters;
  parameters.name = "chain";
  for (std::size_t i = 0; i < 30; ++i) {
    parameters.bodies.push_back({"body" + std::to_string(i), 0.1, 0.1, 0.0, 0.0});
    if (i > 0) parameters.links.push_back({i - 1, i, 2e4, 1.0});
  }
  parameters.loop.sampling_period = 1e-3;
  parameters.loop.sensed = parameters.loop.held = 29;
  const CriticalStiffness result = critical_stiffness(filtered_plant(Device(parameters)));
  std::vector<double> stiffness;
  for (const Crossover& crossover : result.crossovers) {
    if (crossover.stiffness > 3e8) continue;
    EXPECT_EQ(crossover.poles_leaving, 2);
    stiffness.push_back(crossover.stiffness);
  }
  ASSERT_EQ(stiffness.size(), 14u);
  EXPECT_NEAR(stiffness[0] / 1142.635749, 1.0, 1e-9);
  EXPECT_NEAR(stiffness[6] / 34843.178, 1.0, 1e-7);
  EXPECT_NEAR(stiffness[13] / 1.6740588e8, 1.0, 1e-6);
}

}  // namespace
}  // namespace zwidth
