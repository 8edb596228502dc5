#include "identification/inverse_dynamics/motion_bandwidth.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <vector>

#include "signal/fourier.hpp"
#include "signal/median.hpp"

namespace zwidth::internal {
namespace {

// Blocks of lines this much wider than the last one: narrow at slow motions, smooth at fast ones.
constexpr double block_growth = 1.25;
constexpr double least_block_to_noise = 3.0;

/// |1 - e^{-jw}|^4: what the second difference makes of the position's power.
double second_difference_power(double cycles_per_sample) {
  return std::pow(2.0 * std::sin(std::numbers::pi * cycles_per_sample), 4.0);
}

}  // namespace

MotionBandwidth motion_bandwidth(std::span<const double> position) {
  // Second differences need no detrending: drift and offset are gone.
  std::vector<double> acceleration(position.size() - 2);
  for (std::size_t k = 0; k < acceleration.size(); ++k) {
    acceleration[k] = (position[k + 2] - position[k + 1]) - (position[k + 1] - position[k]);
  }
  const auto lines = spectrum(acceleration);
  const double step = 1.0 / static_cast<double>(acceleration.size());
  const auto cycles = [&](std::size_t k) { return step * static_cast<double>(k); };

  std::vector<double> upper;  // power of the position
  for (std::size_t k = lines.size() / 2; k < lines.size(); ++k) {
    upper.push_back(std::norm(lines[k]) / second_difference_power(cycles(k)));
  }
  const double noise = median(std::move(upper)) / std::numbers::ln2;  // mean of an exponential law from its median

  // Power above noise, cumulated up to where a block of lines sinks into it.
  std::vector<double> cumulated{0.0};
  for (std::size_t first = 1; first < lines.size();) {
    const std::size_t end = std::min(
        lines.size(), std::max(first + 8, static_cast<std::size_t>(block_growth * static_cast<double>(first))));
    double block_power = 0.0;
    double block_noise = 0.0;
    for (std::size_t k = first; k < end; ++k) {
      const double power = std::norm(lines[k]);
      const double expected_noise = noise * second_difference_power(cycles(k));
      block_power += power;
      block_noise += expected_noise;
      cumulated.push_back(cumulated.back() + power - expected_noise);
    }
    if (first > 1 && block_power < least_block_to_noise * block_noise) break;
    first = end;
  }
  const double all = *std::max_element(cumulated.begin(), cumulated.end());
  const auto frequency_of = [&](double part) {
    const auto reached =
        std::find_if(cumulated.begin() + 1, cumulated.end(), [&](double power) { return power >= part * all; });
    return reached == cumulated.end() ? 0.5 : cycles(static_cast<std::size_t>(reached - cumulated.begin()));
  };
  return {frequency_of(0.5), frequency_of(0.99)};
}

}  // namespace zwidth::internal
