#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::test {

struct SyntheticNoise {
  double relative = 0.0;  ///< standard deviation of |P|, as a share of it
  std::uint64_t seed = 1;
};

/// The exact sampled response of a device at `count` lines from `lowest_hz` to `highest_hz`, with complex normal noise
/// of known variance.
inline FrequencyResponse synthetic_response(const Device& device, double lowest_hz, double highest_hz, int count,
                                            SyntheticNoise noise) {
  std::mt19937_64 random(noise.seed);
  std::normal_distribution<double> normal(0.0, std::sqrt(0.5));
  const SampledPlant plant = sampled_plant(device);
  FrequencyResponse result;
  result.sampling_period = device.loop().sampling_period;
  for (int i = 0; i < count; ++i) {
    const double hertz = lowest_hz + (highest_hz - lowest_hz) * i / (count - 1);
    ResponsePoint point;
    point.frequency = 2.0 * std::numbers::pi * hertz;
    const std::complex<double> exact = response(plant, point.frequency);
    const double deviation = noise.relative * std::abs(exact);
    point.value = exact + deviation * std::complex<double>(normal(random), normal(random));
    point.variance = deviation * deviation;
    result.points.push_back(point);
  }
  return result;
}

/// What an experiment adds to the commanded force and to the position.
struct RecordNoise {
  double force = 0.0;       ///< standard deviation of the white noise on the force that the device feels
  double resolution = 0.0;  ///< encoder step; its offset is random too
  std::uint64_t seed = 1;
};

/// The position that an encoder reads while the commanded forces move the device from rest, in the open loop.
inline std::vector<double> synthetic_position(const Device& device, std::span<const double> command,
                                              RecordNoise noise) {
  std::mt19937_64 random(noise.seed);
  std::normal_distribution<double> normal(0.0, noise.force);
  std::vector<double> force(command.begin(), command.end());
  if (noise.force > 0.0) {
    for (double& value : force) value += normal(random);
  }
  std::vector<double> position =
      forced_response(sample(state_space(device), {device.loop().sampling_period, device.loop().delay}), force);
  if (noise.resolution > 0.0) {
    const double offset = std::uniform_real_distribution<double>(0.0, noise.resolution)(random);
    for (double& value : position) value = noise.resolution * std::round((value + offset) / noise.resolution);
  }
  return position;
}

}  // namespace zwidth::test
