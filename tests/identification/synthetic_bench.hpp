#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "lhifam.hpp"
#include "zwidth/identification/excitation.hpp"
#include "zwidth/identification/frequency_response.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"
#include "zwidth/sampling/sampled_plant.hpp"

namespace zwidth::test {

/// Force and position of a device that starts at rest, sampled exactly, with white noise.
struct SyntheticRecord {
  std::vector<double> force;
  std::vector<double> position;
  std::size_t period = 0;  // samples; 0: not periodic
};

struct Noise {
  double position = 0.0;        // m, standard deviation: added to the position
  double disturbance = 0.0;     // N: moves the device, is not in the recorded force
  double measured_force = 0.0;  // N: is in the recorded force, does not move the device
};

inline SyntheticRecord synthetic_record(const Device& device, const ExcitationOptions& options, const Noise& noise,
                                        std::uint64_t seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  const Excitation excitation = excite(options);
  SyntheticRecord record{excitation.samples, {}, excitation.period};
  std::vector<double> real = excitation.samples;
  for (double& value : real) value += noise.disturbance * normal(generator);
  const Loop& loop = device.loop();
  record.position = forced_response(sample(state_space(device), {loop.sampling_period, loop.delay}), real);
  for (double& value : record.position) value += noise.position * normal(generator);
  for (double& value : record.force) value += noise.measured_force * normal(generator);
  return record;
}

inline ExcitationOptions multisine(double lowest_hz, double highest_hz, double duration, std::size_t periods) {
  ExcitationOptions options;
  options.kind = ExcitationKind::multisine;
  options.amplitude = 10.0;
  options.lowest_hz = lowest_hz;
  options.highest_hz = highest_hz;
  options.duration = duration;
  options.periods = periods;
  return options;
}

inline ExcitationOptions broadband_noise(double lowest_hz, double highest_hz, double duration, std::uint64_t seed) {
  ExcitationOptions options;
  options.kind = ExcitationKind::noise;
  options.amplitude = 10.0;
  options.lowest_hz = lowest_hz;
  options.highest_hz = highest_hz;
  options.duration = duration;
  options.seed = seed;
  return options;
}

inline ExcitationOptions chirp(double lowest_hz, double highest_hz, double duration) {
  ExcitationOptions options;
  options.amplitude = 10.0;
  options.lowest_hz = lowest_hz;
  options.highest_hz = highest_hz;
  options.duration = duration;
  return options;
}

inline FrequencyResponseOptions over_periods(std::size_t period, std::size_t skipped) {
  FrequencyResponseOptions options;
  options.excitation = FrequencyResponseOptions::Excitation::periodic;
  options.period = period;
  options.skip_periods = skipped;
  return options;
}

inline FrequencyResponseOptions welch() {
  FrequencyResponseOptions options;
  options.excitation = FrequencyResponseOptions::Excitation::aperiodic;
  return options;
}

/// Locked LHIfAM: the motor on its cable to a held handle. Its motion dies out within a few tenths of a second.
inline DeviceParameters locked_lhifam_parameters() {
  DeviceParameters device;
  device.name = "LHIfAM, handle locked";
  device.bodies = {{"motor", 0.3, 15.1, 79.5e3, 0.0}};
  device.loop = {0, 0, 0, 1e-3, 0.0};
  return device;
}

}  // namespace zwidth::test
