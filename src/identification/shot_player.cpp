#include "identification/shot_player.hpp"

#include <algorithm>
#include <cmath>

namespace zwidth::internal {

LaggedForce lagged_force(const Device& device, const MotionRecord& record, std::size_t first, double constant) {
  const double lag = device.parameters().actuator.time_constant;
  if (!(lag > 0.0)) return {};
  const double period = record.sampling_period;
  const SamplingInstants instants = sampling_instants({period, device.loop().delay});
  constexpr double forgotten = 30.0;  // e^-30
  constexpr double most = 1e5;
  const auto length = static_cast<std::size_t>(std::min(most, std::ceil(forgotten * lag / period)));
  const auto at = [&](std::size_t k, std::size_t late) { return record.force[k < late ? 0 : k - late] + constant; };
  LaggedForce now;
  const auto hold = [&](double command, double duration, double of_delay) {
    const double keeps = std::exp(-duration / lag);
    const double distance = (now.force - command) * keeps;
    now.force = command + distance;
    now.of_lag = now.of_lag * keeps + distance * duration / (lag * lag);
    now.of_delay = now.of_delay * keeps - distance * of_delay / lag;
    now.of_constant = 1.0 + (now.of_constant - 1.0) * keeps;
  };
  for (std::size_t k = first < length ? 0 : first - length; k < first; ++k) {
    hold(at(k, instants.whole_samples + 1), instants.with_old, 1.0);
    hold(at(k, instants.whole_samples), instants.with_new, -1.0);
  }
  return now;
}

}  // namespace zwidth::internal
