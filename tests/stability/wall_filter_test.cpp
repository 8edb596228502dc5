// Filters of the wall in the closed loop: another route than modal forms and crossovers is closed_loop.hpp, which runs
// the filters as states.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "lhifam.hpp"
#include "zwidth/design/stable_region.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/closed_loop.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;
using enum WallFilter::Kind;

Device with_filter(WallFilter filter) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.wall.filters = {std::move(filter)};
  return Device(std::move(parameters));
}

WallFilter low_pass_filter(double frequency_hz, int order) {
  WallFilter filter;
  filter.frequency_hz = frequency_hz;
  filter.order = order;
  return filter;
}

WallFilter digital_filter(std::vector<double> numerator, std::vector<double> denominator) {
  WallFilter filter;
  filter.kind = digital;
  filter.numerator = std::move(numerator);
  filter.denominator = std::move(denominator);
  return filter;
}

double excess(const Device& device, double stiffness) {
  Wall wall = device.parameters().wall;
  wall.stiffness = stiffness;
  return stability_excess(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), wall);
}

TEST(WallFilters, CriticalStiffnessIsWhereTheEigenvaluesLeave) {
  WallFilter notch_filter;
  notch_filter.kind = notch;
  notch_filter.frequency_hz = 85.0;
  WallFilter lead = notch_filter;
  lead.kind = lead_lag;
  for (const WallFilter& filter : {low_pass_filter(30.0, 1), low_pass_filter(150.0, 2), notch_filter, lead,
                                   digital_filter({0.5, 0.5}, {1.0, 0.0})}) {
    const Device device = with_filter(filter);
    const double critical = critical_stiffness(device).stiffness;
    ASSERT_GT(critical, 0.0);
    EXPECT_LT(excess(device, critical * (1.0 - 1e-7)), 0.0);
    EXPECT_GT(excess(device, critical * (1.0 + 1e-7)), 0.0);
  }
}

// A mean of the last two samples: F = cos(wT/2) e^{-jwT/2}.
TEST(WallFilters, MeanOfTwoSamplesIsHalfASampleOfDelayAndACosine) {
  const CriticalStiffness critical = critical_stiffness(with_filter(digital_filter({0.5, 0.5}, {1.0, 0.0})));
  ASSERT_TRUE(critical.limit);
  const SampledPlant plain = sampled_plant(Device(test::lhifam_parameters()));
  const double half = 0.5 * critical.limit->frequency * plain.period;
  const std::complex<double> loop =
      critical.stiffness * std::cos(half) * std::polar(1.0, -half) * response(plain, critical.limit->frequency);
  EXPECT_LT(std::abs(loop + 1.0), 1e-10);
}

TEST(WallFilters, ALowPassLeavesNoCrossoverAtNyquist) {
  for (const int order : {1, 2}) {
    for (const Crossover& crossover : critical_stiffness(with_filter(low_pass_filter(150.0, order))).crossovers) {
      EXPECT_LT(crossover.frequency, 0.999999 * pi / 1e-3);
    }
  }
}

TEST(WallFilters, AFactorOfOneHalfDoublesTheAnyUserLimit) {
  const AbsoluteStabilityLimit plain = absolute_stability_limit(Device(test::lhifam_parameters()));
  const AbsoluteStabilityLimit halved = absolute_stability_limit(with_filter(digital_filter({0.5, 0.0}, {1.0, 0.0})));
  EXPECT_NEAR(halved.stiffness / plain.stiffness, 2.0, 1e-9);
}

TEST(WallFilters, MarginsAreThoseOfTheFilteredLoop) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.wall.filters = {low_pass_filter(30.0, 1)};
  const double critical = critical_stiffness(Device(parameters)).stiffness;
  parameters.wall.stiffness = 0.5 * critical;
  const Analysis analysis = analyze(Device(parameters));
  ASSERT_TRUE(analysis.wall && analysis.wall->gain_margin);
  EXPECT_TRUE(analysis.wall->stable);
  EXPECT_NEAR(*analysis.wall->gain_margin, 2.0, 1e-9);
  parameters.wall.stiffness = 1.001 * critical;
  const Analysis beyond = analyze(Device(parameters));
  EXPECT_FALSE(beyond.wall->stable);
  EXPECT_GT(beyond.wall->spectral_radius, 1.0);
}

TEST(WallFilters, RegionStartsAtTheCriticalStiffness) {
  for (const int order : {1, 2}) {
    const Device device = with_filter(low_pass_filter(200.0, order));
    const StableRegion region = stable_region(StableWalls(filtered_plant(device)));
    EXPECT_NEAR(region.critical_stiffness / critical_stiffness(device).stiffness, 1.0, 1e-9);
  }
}

}  // namespace
}  // namespace zwidth
