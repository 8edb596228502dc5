#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth {

/// An experiment as a recorder would keep it, computed instead of measured.
struct SyntheticRecord {
  std::vector<double> force;     ///< as commanded, N or N m
  std::vector<double> position;  ///< of the sensed body as its encoder reads it, m or rad
  double sampling_period = 0.0;  ///< s
};

/// What is wrong with the sensors and the clock.
struct SyntheticNoise {
  double force = 0.0;      ///< standard deviation of the white noise that the device feels besides the command
  std::uint64_t seed = 1;  ///< of that noise
};

/// Plays the commanded forces, held over each sampling period of the device, through its exact sampled model from rest,
/// and reads the position with the device's encoder (rounded to the nearest step; no rounding without a resolution).
/// Whatever is locked in the experiment must be so in `device` (locked_device()).
[[nodiscard]] SyntheticRecord synthetic_record(const Device& device, std::span<const double> command,
                                               const SyntheticNoise& noise);

}  // namespace zwidth
