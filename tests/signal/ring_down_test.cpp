#include "zwidth/signal/ring_down.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

constexpr double period = 1e-3;

std::vector<double> ringing(double frequency, double rate, double offset, std::size_t samples) {
  std::vector<double> signal;
  for (std::size_t k = 0; k < samples; ++k) {
    const double t = static_cast<double>(k) * period;
    signal.push_back(offset + 1e-3 * std::exp(rate * t) * std::cos(frequency * t + 0.3));
  }
  return signal;
}

TEST(RingDown, GrowthAndFrequencyOfOneOscillation) {
  std::mt19937_64 engine(7);
  for (int i = 0; i < 200; ++i) {
    const double frequency = std::exp(std::uniform_real_distribution<double>(std::log(20.0), std::log(1500.0))(engine));
    const double rate = std::uniform_real_distribution<double>(-0.03, 0.01)(engine) * frequency;
    const double offset = std::uniform_real_distribution<double>(-1e-3, 1e-3)(engine);
    const auto samples = static_cast<std::size_t>(40.0 * 6.2832 / frequency / period);
    const auto ring = ring_down(ringing(frequency, rate, offset, samples), period, 1.15 * frequency);
    ASSERT_TRUE(ring) << "seed 7, case " << i << ", " << frequency << " rad/s, " << rate << " 1/s";
    EXPECT_NEAR(ring->frequency, frequency, 1e-3 * frequency) << "seed 7, case " << i;
    EXPECT_NEAR(ring->growth_rate, rate, 2e-4 * frequency) << "seed 7, case " << i;
  }
}

TEST(RingDown, AnOscillationBesideAStrongerOneThatDiesOut) {
  std::vector<double> signal = ringing(250.0, 0.5, 0.0, 4000);
  const std::vector<double> other = ringing(40.0, -2.0, 0.0, 4000);
  for (std::size_t k = 0; k < signal.size(); ++k) signal[k] += 10.0 * other[k];
  const auto ring = ring_down(signal, period, 250.0);
  ASSERT_TRUE(ring);
  EXPECT_NEAR(ring->frequency, 250.0, 0.25);
  EXPECT_NEAR(ring->growth_rate, 0.5, 0.05);
}

TEST(RingDown, NoneInNoiseInRestAndInAShortRecord) {
  std::mt19937_64 engine(3);
  std::vector<double> noise(4000);
  for (double& x : noise) x = std::normal_distribution<double>()(engine);
  EXPECT_FALSE(ring_down(std::vector<double>(4000, 0.1), period, 100.0));
  EXPECT_FALSE(ring_down(ringing(100.0, 0.0, 0.0, 300), period, 100.0));
  EXPECT_FALSE(ring_down(ringing(100.0, -50.0, 0.0, 4000), period, 100.0, 1e-4)) << "it is below the floor at once";
  EXPECT_FALSE(ring_down(ringing(100.0, 0.0, 0.0, 4000), period, 450.0)) << "no oscillation is near";
}

TEST(RingDown, RefusesWhatIsNoSignal) {
  EXPECT_THROW((void)ring_down(std::vector<double>(100, std::numeric_limits<double>::quiet_NaN()), period, 10.0),
               Error);
  EXPECT_THROW((void)ring_down(std::vector<double>(100), period, 4000.0), Error) << "above Nyquist's frequency";
  EXPECT_THROW((void)ring_down(std::vector<double>(100), 0.0, 10.0), Error);
}

}  // namespace
}  // namespace zwidth
