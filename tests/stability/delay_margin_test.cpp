// The delay margin of any real delay, against eigenvalues of the loop sampled with that delay.
#include <gtest/gtest.h>

#include <cmath>

#include "lhifam.hpp"
#include "property/random_devices.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/stability/closed_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth {
namespace {

double excess_with(const DeviceParameters& parameters, double added) {
  const double delay = parameters.loop.delay + added;
  return stability_excess(sample(state_space(Device(parameters)), {parameters.loop.sampling_period, delay}),
                          parameters.wall);
}

// Stable with hardly less delay added, unstable with hardly more.
void expect_edge(const DeviceParameters& device, double margin) {
  EXPECT_LT(excess_with(device, margin * (1.0 - 1e-9)), 0.0);
  EXPECT_GT(excess_with(device, margin * (1.0 + 1e-9)), 0.0);
}

// 625.7 us where a fraction of a sample is taken as a pure lag; 531 us is true.
TEST(DelayMargin, OfASlowlySampledBody) {
  DeviceParameters device;
  device.name = "paddle";
  device.bodies = {{"body", 0.0271133, 1.11861, 0.0, 0.0}};
  device.loop.sampling_period = 1e-2;
  device.wall = {230.03728124911032, 4.0647174828, 0.0};
  const double margin = wall_margins(Device(device)).delay_margin.value();
  EXPECT_NEAR(margin, 531e-6, 0.5e-6);
  expect_edge(device, margin);
}

// Theory, section 7: by bisection on the spectral radius.
TEST(DelayMargin, IsTheLeastOverAllCrossovers) {
  DeviceParameters device;
  device.name = "collocated mode";
  device.bodies = {{"motor", 1.0, 0.2, 0.0, 0.0}, {"handle", 0.3, 0.0, 0.0, 0.0}};
  device.links = {{0, 1, 830.0, 0.3}};
  device.loop = {0, 0, 1, 1e-3, 0.0};
  device.wall = {10.0, 6.0, 0.0};
  EXPECT_NEAR(wall_margins(Device(device)).delay_margin.value(), 0.04403901, 1e-8);
}

// The loop gain at Nyquist passes -1 between two samples of delay, and falls back: no pair of crossovers tells of it.
// A crossover there at no delay has 3.1 ms. From the roots of the characteristic polynomial in 200 digits.
TEST(DelayMargin, IsReachedAtNyquistWithinASample) {
  DeviceParameters device;
  device.name = "suspended";
  device.bodies = {{"body", 0.021271167732987626, 7.752012274204508, 98453.27802428622, 0.0}};
  device.loop.sampling_period = 0.002673877831365266;
  device.wall = {97196.09424831664, 0.010096565883620229, 0.0};
  const double margin = wall_margins(Device(device)).delay_margin.value();
  EXPECT_NEAR(margin, 5.40004532601402e-4, 1e-12);
  expect_edge(device, margin);
}

// Within the first sample the loop gain at Nyquist passes 1, which is -1 a sample later. In 200 digits, likewise.
TEST(DelayMargin, IsReachedAtNyquistASampleLater) {
  DeviceParameters device;
  device.name = "suspended";
  device.bodies = {{"body", 1.0, 0.57, 9.1, 0.0}};
  device.loop.sampling_period = 1.0;
  device.wall.stiffness = 1.6;
  EXPECT_NEAR(wall_margins(Device(device)).delay_margin.value(), 1.7712052593809626, 1e-12);
}

// Stable at every delay looked at below the margin, and unstable just above it.
TEST(DelayMargin, OfRandomDevicesIsTheFirstEdge) {
  constexpr double most_samples = 60.0;  // eigenvalues cost their cube
  int seen = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    test::RandomDevices random(seed);
    const auto kind = test::device_kinds[seed % test::device_kinds.size()];
    DeviceParameters device = random.device(kind);
    const double limit = critical_stiffness(filtered_plant(Device(device)), virtual_damper(Device(device))).stiffness;
    if (!(limit > 0.0) || !std::isfinite(limit)) continue;
    device.wall.stiffness = limit * random.uniform(0.02, 0.98);
    const double period = device.loop.sampling_period;
    SCOPED_TRACE(testing::Message() << "seed " << seed << " " << kind << " K " << *device.wall.stiffness);
    const WallMargins margins = wall_margins(Device(device));
    ASSERT_TRUE(margins.stable);
    if (!margins.delay_margin) {
      for (const double samples : {0.3, 1.0, 7.7}) EXPECT_LT(excess_with(device, samples * period), 1e-12);
      continue;
    }
    const double margin = *margins.delay_margin;
    if (device.loop.delay + margin > most_samples * period) continue;
    ++seen;
    EXPECT_LT(excess_with(device, margin * (1.0 - 1e-6)), 0.0);
    EXPECT_GT(excess_with(device, margin * (1.0 + 1e-6)), 0.0);
    for (int i = 1; i < 20; ++i) EXPECT_LT(excess_with(device, margin * i / 20.0), 1e-12) << i;
  }
  EXPECT_GT(seen, 100);
}

}  // namespace
}  // namespace zwidth
