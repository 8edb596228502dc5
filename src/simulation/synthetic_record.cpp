#include "zwidth/simulation/synthetic_record.hpp"

#include <cmath>
#include <random>

#include "zwidth/model/state_space.hpp"
#include "zwidth/sampling/forced_response.hpp"

namespace zwidth {

SyntheticRecord synthetic_record(const Device& device, std::span<const double> command, const SyntheticNoise& noise) {
  require_no_coordinates(device);
  const Loop& loop = device.loop();
  const double step = device.parameters().sensor.resolution;
  std::mt19937_64 generator(noise.seed);
  std::normal_distribution<double> normal;
  ForcedMotion motion(sample(state_space(device), {loop.sampling_period, loop.delay}));
  SyntheticRecord record{{command.begin(), command.end()}, {}, loop.sampling_period};
  record.position.reserve(command.size());
  for (const double force : command) {
    const double position = motion.step(force + noise.force * normal(generator));
    record.position.push_back(step > 0.0 ? step * std::round(position / step) : position);
  }
  return record;
}

}  // namespace zwidth
