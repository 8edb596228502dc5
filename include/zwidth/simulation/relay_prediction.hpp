#pragma once

#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/simulation/limit_cycle.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth {

/// What theory expects of a relay experiment on a device. Each entry leaves something out; see its line.
struct RelayPrediction {
  CriticalStiffness linear;                     ///< exact for a wall; neither relay nor friction
  std::vector<LimitCycle> describing_function;  ///< relay and friction by their first harmonics
  std::vector<LimitCycle> sampled_relay;        ///< exact for the sampled relay; no friction, no encoder
  /// Exact for a continuous relay whose delay is t_d + T/2, the mean age of the sampled one's decision; no friction.
  std::vector<LimitCycle> continuous_relay;
  double lowest_frequency = 0.0;  ///< rad/s; exact cycles below it were not looked for
};

/// All predictions, of cycles down to a fifth of the frequency of the device's lowest crossover, at most 20 000 samples
/// long (shorter ones on devices of more than some 20 bodies). Encoder, force limit and wall of the device are left
/// out, but for a damper that loop.damper runs apart: it is closed, and exact cycles are then left out. Throws Error (invalid_argument) for a relay outside its domain.
[[nodiscard]] RelayPrediction relay_prediction(const Device& device, const Relay& relay, const Progress& progress = {});

}  // namespace zwidth
