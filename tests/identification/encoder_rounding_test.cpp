// What an encoder rounds off in step with a sweep, against sines that are rounded here.
#include "identification/response/encoder_rounding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "zwidth/identification/frequency_response.hpp"

namespace zwidth {
namespace {

using internal::SweepRounding;

constexpr std::size_t samples = 4000;
constexpr double step = 0.002;

/// A force of amplitude 1 that sweeps, and the position that it moves by `value`, in whole steps.
struct Swept {
  std::vector<double> force;
  std::vector<double> position;
};

Swept swept(double value, double noise) {
  Swept made;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, noise * step);
  double phase = 0.0;
  for (std::size_t k = 0; k < samples; ++k) {
    phase += 2.0 * std::numbers::pi * (0.002 + 0.01 * static_cast<double>(k) / static_cast<double>(samples));
    made.force.push_back(std::sin(phase));
    made.position.push_back(step * std::round((value * std::sin(phase) + normal(random)) / step));
  }
  return made;
}

/// Mean square of what rounding does to the fundamental of a sine, as a share of its power, over offsets and over
/// amplitudes around this one: the Bessel functions' waves are not told.
double simulated_share(double amplitude, double noise, int samples_of_turn) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal(0.0, noise);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  constexpr int trials = 400;
  double sum = 0.0;
  for (int trial = 0; trial < trials; ++trial) {
    const double size = amplitude + 0.5 * (unit(random) - 0.5);
    const double offset = unit(random);
    std::complex<double> fundamental = 0.0;
    for (int k = 0; k < samples_of_turn; ++k) {
      const double angle = 2.0 * std::numbers::pi * k / samples_of_turn;
      const double rounded = std::round(size * std::sin(angle) + offset + normal(random));
      fundamental += (rounded - offset) * std::polar(2.0 / samples_of_turn, -angle);
    }
    sum += std::norm(fundamental - std::complex<double>(0.0, -size)) / (size * size);
  }
  return sum / trials;
}

TEST(EncoderRounding, IsThatOfSinesRoundedOverAllOffsets) {
  for (const double amplitude : {1.0, 2.0, 4.0, 10.0}) {
    const Swept record = swept(amplitude * step, 0.0);
    const double share =
        SweepRounding(record.force, record.position).variance({0.0, amplitude * step}) / std::pow(amplitude * step, 2);
    EXPECT_NEAR(share / simulated_share(amplitude, 0.0, 2000), 1.0, 0.3) << amplitude << " steps";
  }
}

TEST(EncoderRounding, IsAsLargeAsAMotionOfLessThanAStep) {
  const Swept record = swept(3.0 * step, 0.0);
  const double value = 0.1 * step;
  EXPECT_NEAR(SweepRounding(record.force, record.position).variance(value) / (value * value), 1.0, 0.02);
}

TEST(EncoderRounding, IsTakenOffByNoise) {
  constexpr double amplitude = 2.0;
  const auto share = [](double noise) {
    const Swept record = swept(amplitude * step, noise);
    return SweepRounding(record.force, record.position).variance(amplitude * step) / std::pow(amplitude * step, 2);
  };
  EXPECT_LT(share(0.6), 0.01 * share(0.0));
  constexpr int many = 10000;  // what is left is the mean of so much noise
  EXPECT_LT(simulated_share(amplitude, 0.6, many), 0.05 * simulated_share(amplitude, 0.0, many));
}

TEST(EncoderRounding, MayBeAMotionOfHalfAStepWhereNothingDithersIt) {
  EXPECT_NEAR(internal::largest_rounding(swept(3.0 * step, 0.1).position), 0.5 * step, 1e-9 * step);
  EXPECT_EQ(internal::largest_rounding(swept(3.0 * step, 0.6).position), 0.0);
  EXPECT_EQ(internal::largest_rounding(swept(3.0 * step, 0.0).force), 0.0);  // no steps
}

// A velocity that was differenced from such a position has steps of step / T, which are no encoder's.
TEST(EncoderRounding, IsThatOfPositionsAlone) {
  const Swept record = swept(3.0 * step, 0.0);
  std::vector<double> velocity(samples, 0.0);
  for (std::size_t k = 1; k < samples; ++k) velocity[k] = (record.position[k] - record.position[k - 1]) / 1e-3;
  ASSERT_GT(SweepRounding(record.force, velocity).variance(3.0 * step), 0.0);
  FrequencyResponseOptions options;
  options.output = OutputQuantity::velocity;
  for (const ResponsePoint& point : frequency_response(record.force, velocity, 1e-3, options).points) {
    EXPECT_LT(point.variance, 0.5 * std::norm(point.value)) << point.frequency;
  }
}

TEST(EncoderRounding, IsNoneOfAForceOfManyLinesNorOfAPositionWithoutSteps) {
  const Swept record = swept(2.0 * step, 0.0);
  std::vector<double> noise;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (std::size_t k = 0; k < samples; ++k) noise.push_back(normal(random));
  EXPECT_EQ(SweepRounding(noise, record.position).variance(step), 0.0);
  EXPECT_EQ(SweepRounding(record.force, noise).variance(step), 0.0);
  EXPECT_EQ(SweepRounding(record.force, record.position).variance(0.0), 0.0);
}

}  // namespace
}  // namespace zwidth
