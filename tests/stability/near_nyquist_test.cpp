// Modes and corners of filters at the Nyquist frequency, and crossovers where a notch all but closes: polynomials in z - 1
// lose digits there. Every crossover is held to 1e-9 by a count in 200 digits.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "exact_closed_loop.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {
namespace {

constexpr double promised = 1e-9;

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double log_uniform(double least, double most) {
    return std::exp(std::uniform_real_distribution(std::log(least), std::log(most))(engine_));
  }
  std::size_t below(std::size_t count) { return engine_() % count; }

 private:
  std::mt19937_64 engine_;
};

void expect_promised(const DeviceParameters& parameters, const std::string& what) {
  const Device device(parameters);
  const CriticalStiffness result = critical_stiffness(device);
  EXPECT_TRUE(result.trust.sound()) << what;
  const test::ExactClosedLoop loop(device);
  for (const Crossover& each : result.crossovers) {
    EXPECT_EQ(
        loop.poles_outside((1.0 + promised) * each.stiffness) - loop.poles_outside((1.0 - promised) * each.stiffness),
        each.poles_leaving)
        << what << " K = " << each.stiffness << " at " << each.frequency;
  }
  if (result.status == StiffnessStatus::finite) {
    EXPECT_EQ(loop.poles_outside((1.0 - promised) * result.stiffness), 0) << what;
    EXPECT_EQ(loop.poles_outside(0.1 * result.stiffness), 0) << what;
  }
}

// Two bodies whose mode lies at a frequency.
DeviceParameters with_mode(Random& random, double frequency, double damping_ratio) {
  DeviceParameters parameters;
  parameters.name = "near Nyquist";
  const double motor = random.log_uniform(0.05, 2.0);
  const double handle = random.log_uniform(0.05, 2.0);
  const double reduced = motor * handle / (motor + handle);
  parameters.bodies = {{"motor", motor, random.log_uniform(0.01, 3.0), 0.0, 0.0}, {"handle", handle, 0.0, 0.0, 0.0}};
  parameters.links = {{0, 1, reduced * frequency * frequency, 2.0 * damping_ratio * reduced * frequency}};
  parameters.loop.sampling_period = 1e-3;
  parameters.loop.held = 1;
  if (random.below(3) == 0) parameters.loop.delay = 1.3e-3;
  return parameters;
}

TEST(NearNyquist, ModesThere) {
  const double nyquist = std::numbers::pi / 1e-3;
  for (unsigned seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const double aside = random.log_uniform(1e-9, 1e-2) * (seed % 2 == 0 ? 1.0 : -1.0);
    DeviceParameters parameters =
        with_mode(random, nyquist * (seed % 5 == 0 ? 3.0 : 1.0) * (1.0 + aside), random.log_uniform(1e-6, 1e-2));
    if (seed % 4 == 0) parameters.loop.sensed = 1;
    expect_promised(parameters, "seed " + std::to_string(seed));
  }
}

TEST(NearNyquist, CornersOfFiltersThere) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    Random random(seed);
    DeviceParameters parameters = with_mode(random, random.log_uniform(100.0, 6000.0), random.log_uniform(1e-3, 1e-1));
    WallFilter filter;
    filter.frequency_hz = 500.0 * (1.0 - random.log_uniform(1e-7, 1e-3));
    const double w = 2.0 * std::numbers::pi * filter.frequency_hz;
    switch (seed % 4) {
      case 0:
        filter.kind = WallFilter::Kind::biquad;
        filter.numerator = {0.5 / (w * w), 0.3 / w, 1.0};
        filter.denominator = {1.0 / (w * w), 0.1 / w, 1.0};
        break;
      case 1:
        filter.kind = WallFilter::Kind::low_pass;
        filter.order = 1 + static_cast<int>(random.below(2));
        break;
      case 2:
        filter.kind = WallFilter::Kind::notch;
        filter.damping_ratio = 0.1;
        break;
      default:
        filter.kind = WallFilter::Kind::lead_lag;
        filter.ratio = 4.0;
    }
    parameters.wall.filters = {filter};
    expect_promised(parameters, "seed " + std::to_string(seed));
  }
}

TEST(NearNyquist, FarCrossoversBesideDeepNotches) {
  for (unsigned seed = 0; seed < 60; ++seed) {
    Random random(seed);
    DeviceParameters parameters = with_mode(random, random.log_uniform(100.0, 3000.0), random.log_uniform(1e-4, 1e-1));
    WallFilter notch;
    notch.kind = WallFilter::Kind::notch;
    notch.frequency_hz = random.log_uniform(5.0, 450.0);
    notch.damping_ratio = random.log_uniform(0.01, 0.5);
    notch.depth = random.log_uniform(1e-6, 1e-2);
    parameters.wall.filters = {notch};
    if (seed % 3 == 0) parameters.wall.filters.push_back(notch);
    if (seed % 4 == 0) parameters.wall.damping = random.log_uniform(0.1, 5.0);
    expect_promised(parameters, "seed " + std::to_string(seed));
  }
}

}  // namespace
}  // namespace zwidth
