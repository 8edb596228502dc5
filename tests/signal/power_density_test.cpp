#include "zwidth/signal/power_density.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "zwidth/error.hpp"

namespace zwidth {
namespace {

double total(const PowerDensity& density) {
  return density.step_hz * std::accumulate(density.values.begin(), density.values.end(), 0.0);
}

TEST(PowerDensity, SumsToTheMeanSquare) {
  std::mt19937_64 generator(3);
  std::normal_distribution<double> normal;
  for (const std::size_t size : {2U, 3U, 100U, 997U}) {
    std::vector<double> signal(size);
    for (double& each : signal) each = 1.0 + normal(generator);
    const double mean_square =
        std::inner_product(signal.begin(), signal.end(), signal.begin(), 0.0) / static_cast<double>(size);
    EXPECT_NEAR(total(power_density(signal, 50.0)), mean_square, 1e-12 * mean_square) << size;
  }
}

TEST(PowerDensity, PutsASineAtItsFrequency) {
  std::vector<double> sine(2000);
  for (std::size_t k = 0; k < sine.size(); ++k) {
    sine[k] = 3.0 * std::sin(2.0 * std::numbers::pi * 0.05 * static_cast<double>(k));
  }
  const PowerDensity density = power_density(sine, 400.0);  // 20 Hz
  EXPECT_DOUBLE_EQ(density.step_hz, 0.2);
  EXPECT_NEAR(density.values[100] * density.step_hz, 4.5, 1e-12);
  EXPECT_NEAR(total(density), 4.5, 1e-12);
}

TEST(PowerDensity, OfALongSignalIsTheMeanOverBlocks) {
  std::vector<double> signal((std::size_t{1} << 21) + 5);
  for (std::size_t k = 0; k < signal.size(); ++k) signal[k] = k < (std::size_t{1} << 20) ? 1.0 : 3.0;
  const PowerDensity density = power_density(signal, 1.0);
  EXPECT_EQ(density.values.size(), (std::size_t{1} << 19) + 1);
  EXPECT_NEAR(total(density), 5.0, 1e-12);  // (1 + 9) / 2
}

TEST(PowerDensity, RefusesWhatHasNone) {
  EXPECT_THROW((void)power_density(std::vector<double>{1.0}, 1.0), Error);
  EXPECT_THROW((void)power_density(std::vector<double>{1.0, std::nan("")}, 1.0), Error);
  EXPECT_THROW((void)power_density(std::vector<double>{1.0, 2.0}, 0.0), Error);
}

}  // namespace
}  // namespace zwidth
