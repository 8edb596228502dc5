#include "zwidth/stability/force_per_count.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "zwidth/control/sampled_controller.hpp"

namespace zwidth {
namespace {

constexpr double period = 1e-3;
constexpr double resolution = 3.14e-6;

/// The controller that runs, fed with one step of the encoder: its largest force.
double largest_of_controller(const Wall& wall) {
  SampledController controller(wall_controller(wall), period);
  EXPECT_EQ(controller.update(0.0), 0.0);
  double largest = 0.0;
  for (int k = 0; k < 20000; ++k) largest = std::max(largest, std::abs(controller.update(resolution)));
  return largest;
}

TEST(ForcePerCount, IsWhatTheControllerDoesAfterOneStep) {
  for (const double cutoff : {0.0, 30.0, 200.0}) {
    for (int filters = 0; filters < 3; ++filters) {
      Wall wall{.stiffness = 5000.0, .damping = 20.0, .velocity_filter_hz = cutoff};
      WallFilter notch{.kind = WallFilter::Kind::notch, .frequency_hz = 80.0, .damping_ratio = 0.1, .depth = 0.05};
      WallFilter lead{.kind = WallFilter::Kind::lead_lag, .frequency_hz = 60.0, .ratio = 6.0};
      if (filters > 0) wall.filters.push_back(notch);
      if (filters > 1) wall.filters.push_back(lead);
      const ForcePerCount force = force_per_count(wall, period, resolution);
      EXPECT_NEAR(force.largest / largest_of_controller(wall), 1.0, 1e-9);
      EXPECT_DOUBLE_EQ(force.stiffness, 5000.0 * resolution);
      const double a = cutoff > 0.0 ? std::exp(-2.0 * std::numbers::pi * cutoff * period) : 0.0;
      EXPECT_NEAR(force.damping, 20.0 * (1.0 - a) * resolution / period, 1e-15);
      if (filters == 0) {
        EXPECT_DOUBLE_EQ(force.largest, force.stiffness + force.damping);
      }
      // Rates bound it.
      const ForcePerCountRates rates = force_per_count_rates(wall, period, resolution);
      EXPECT_LE(force.largest, (5000.0 * rates.per_stiffness + 20.0 * rates.per_damping) * (1.0 + 1e-12));
    }
  }
}

TEST(ForcePerCount, IsAbsentWithoutAnEncoderOrAWall) {
  DeviceParameters parameters;
  parameters.bodies.push_back({"a", 1.0, 1.0});
  parameters.loop.sampling_period = period;
  EXPECT_FALSE(force_per_count(Device(parameters)));
  parameters.sensor.resolution = resolution;
  EXPECT_FALSE(force_per_count(Device(parameters)));
  parameters.wall.stiffness = 100.0;
  EXPECT_TRUE(force_per_count(Device(parameters)));
}

}  // namespace
}  // namespace zwidth
