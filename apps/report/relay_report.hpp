#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/remark.hpp"
#include "zwidth/simulation/relay_experiment.hpp"
#include "zwidth/simulation/relay_prediction.hpp"

namespace zwidth::report {

/// A relay experiment, simulated or recorded, with what theory expects of it: the input of text, JSON, CSV and figure.
struct RelayReport {
  enum class Source { simulation, recording };
  Source source = Source::simulation;
  std::string recording;  ///< the file's name
  Motion motion = Motion::linear;
  double sampling_period = 0.0;               ///< s
  Relay relay;                                ///< of a recording: half of the force's peak to peak, no hysteresis known
  std::vector<RelayTrial> trials;             ///< a recording is one
  std::optional<Device> device;               ///< with the delay added; of a recording, where one is given
  std::optional<RelayPrediction> prediction;  ///< with a device
  std::vector<Remark> remarks;                ///< of reading the recording
};

/// Means over the trials that oscillate.
struct RelayMean {
  std::size_t trials = 0;
  double frequency = 0.0;  ///< rad/s
  double stiffness = 0.0;  ///< geometric: the mean of the decibels
  double amplitude = 0.0;
  double lowest_frequency = 0.0;   ///< of a trial, rad/s
  double highest_frequency = 0.0;  ///< rad/s
};

/// Nothing where no trial oscillates.
[[nodiscard]] std::optional<RelayMean> mean_of(const std::vector<RelayTrial>& trials);

/// Oscillations that lie side by side: each within a tenth of the next one's frequency.
struct CycleBand {
  std::size_t count = 0;
  LimitCycle lowest;
  LimitCycle highest;
};

/// `cycles` by rising frequency.
[[nodiscard]] std::vector<CycleBand> cycle_bands(const std::vector<LimitCycle>& cycles);

/// Whether two frequencies agree within 15 %, either way: a relay's square wave on a lightly damped rigid device slows
/// its oscillation by 9 % against the crossover, the sampling by a little more.
[[nodiscard]] bool is_near(double frequency, double other);

/// Of the recording, and that the device's [wall] is left out where it has a damper or filters.
[[nodiscard]] std::vector<Remark> remarks_of(const RelayReport& report);

/// Largest friction of the device over the relay's force; 0 without.
[[nodiscard]] double friction_level(const RelayReport& report);

}  // namespace zwidth::report
