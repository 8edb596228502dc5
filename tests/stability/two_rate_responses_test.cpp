// What the spring sees of a device whose faster damper is closed in a loop of its own: its response and its models.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "../lhifam.hpp"
#include "zwidth/error.hpp"
#include "zwidth/stability/analysis.hpp"
#include "zwidth/stability/bode.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/device_model.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

using std::numbers::pi;

struct Timing {
  double spring_delay = 0.0;
  double damper_delay = 0.0;
  double velocity_filter_hz = 0.0;
};

Device with_faster_damper(const Timing& timing) {
  DeviceParameters parameters = test::lhifam_parameters();
  parameters.loop.delay = timing.spring_delay;
  parameters.loop.damper = LoopDamper{1e-4, timing.damper_delay};
  parameters.wall.damping = 100.0;
  parameters.wall.velocity_filter_hz = timing.velocity_filter_hz;
  parameters.wall.stiffness = 5e4;
  return Device(parameters);
}

constexpr Timing timings[] = {{}, {0.0, 1.3e-4, 0.0}, {1.27e-3, 2.5e-4, 300.0}, {2e-3, 1e-4, 0.0}};

bool has(const std::vector<Remark>& remarks, FindingCode code) {
  return std::ranges::any_of(remarks, [&](const Remark& each) { return each.finding && each.finding->code == code; });
}

// The state space is stepped from event to event by the matrix exponential, the terms are partial fractions decimated.
TEST(TwoRateResponses, TheStateSpaceAndTheTermsAreOnePlant) {
  for (const Timing& timing : timings) {
    const DeviceModel model = device_model(with_faster_damper(timing));
    EXPECT_EQ(model.wall.damping, 0.0);
    EXPECT_TRUE(has(model.remarks, FindingCode::damper_closed_at_own_rate));
    for (const double frequency : {1.0, 30.0, 400.0, 1274.0, 3000.0, pi / 1e-3}) {
      const std::complex<double> stepped = response(model.discrete, frequency);
      const std::complex<double> summed = response(filtered_plant(model.sampled, {}), frequency);
      EXPECT_NEAR(std::abs(stepped / summed - 1.0), 0.0, 1e-7) << frequency;
    }
  }
}

TEST(TwoRateResponses, ClosingTheSpringAroundTheModelIsTheLoopAsItRuns) {
  for (const Timing& timing : timings) {
    const Device device = with_faster_damper(timing);
    const DeviceModel model = device_model(device);
    double largest = 0.0;
    for (const std::complex<double>& delta : closed_loop_poles_minus_one(*model.with_delay_states, model.wall)) {
      largest = std::max(largest, std::abs(1.0 + delta));
    }
    EXPECT_NEAR(largest, wall_margins(device).spectral_radius, 1e-9);
  }
}

TEST(TwoRateResponses, BodeIsThatOfTheModelAndMeetsEveryCrossover) {
  for (const Timing& timing : timings) {
    const Device device = with_faster_damper(timing);
    const DeviceModel model = device_model(device);
    const Bode found = bode(device, {.points = 100});
    EXPECT_TRUE(has(found.analysis.remarks, FindingCode::damper_closed_at_own_rate));
    ASSERT_GE(found.sampled.size(), 100U);
    for (const BodePoint& point : found.sampled) {
      const std::complex<double> expected = response(model.discrete, point.frequency);
      EXPECT_NEAR(point.magnitude_db, 20.0 * std::log10(std::abs(expected)), 1e-5) << point.frequency;
      EXPECT_NEAR(std::remainder(point.phase_deg - std::arg(expected) * 180.0 / pi, 360.0), 0.0, 1e-4);
    }
    ASSERT_FALSE(found.analysis.critical.crossovers.empty());
    for (const Crossover& each : found.analysis.critical.crossovers) {
      EXPECT_NEAR(std::abs(1.0 + each.stiffness * response(model.discrete, each.frequency)), 0.0, 1e-6);
    }
  }
}

TEST(TwoRateResponses, ADamperThatDoesNothingLeavesTheDeviceAsItIs) {
  DeviceParameters parameters = with_faster_damper({}).parameters();
  parameters.wall.damping = 0.0;
  const Device apart(parameters);
  parameters.loop.damper.reset();
  const Device together(parameters);
  const Bode first = bode(apart);
  const Bode second = bode(together);
  ASSERT_EQ(first.sampled.size(), second.sampled.size());
  EXPECT_EQ(first.sampled.back().magnitude_db, second.sampled.back().magnitude_db);
  EXPECT_FALSE(has(first.analysis.remarks, FindingCode::damper_closed_at_own_rate));
  EXPECT_EQ(device_model(apart).discrete.Phi, device_model(together).discrete.Phi);
  EXPECT_TRUE(device_model(apart).remarks.empty());
}

TEST(TwoRateResponses, BehindASlowerDamperThereIsNone) {
  DeviceParameters parameters = with_faster_damper({}).parameters();
  parameters.loop.sampling_period = 1e-4;
  parameters.loop.damper = LoopDamper{1e-3, 0.0};
  const Device device(parameters);
  EXPECT_THROW((void)bode(device), Error);
  EXPECT_THROW((void)device_model(device), Error);
}

TEST(TwoRateResponses, AForceManyPeriodsLateIsNoMatterOfUnits) {
  DeviceParameters parameters = with_faster_damper({8.8e-3, 8.8e-3, 0.0}).parameters();
  parameters.wall.damping = 20.0;
  const CriticalStiffness critical = critical_stiffness(Device(parameters));
  ASSERT_TRUE(critical.trust.refused());
  const Error expected(ErrorCode::did_not_converge,
                       {.code = ProblemCode::inner_loop_poles_not_found, .evidence = {{"periods", 88.0}}});
  EXPECT_NE(critical.trust.reasons.front().find(expected.what()), std::string::npos) << critical.trust.reasons.front();
}

}  // namespace
}  // namespace zwidth
