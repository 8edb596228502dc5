#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/simulation/limit_cycle.hpp"
#include "zwidth/simulation/relay_record.hpp"

namespace zwidth {

inline constexpr std::size_t least_relay_samples = 64;         ///< per trial
inline constexpr std::size_t most_relay_samples = 20'000'000;  ///< of all trials together: they are kept

/// The experiment: which relay, how often, for how long.
struct RelayOptions {
  Relay relay;                    ///< in the place of the wall
  double duration = 20.0;         ///< s per trial
  std::size_t trials = 4;         ///< >= 1
  double start_offset = 0.0;      ///< m or rad: all bodies start there at rest
  double variation = 0.05;        ///< relative, in [0, 1): of the start offset and of every friction, drawn per trial
  std::uint64_t seed = 1;         ///< of the variation; equal seeds give equal trials, whatever the number of threads
  std::size_t threads = 0;        ///< 0: as many as the machine has
  RelayAnalysisOptions analysis;  ///< of the oscillation
};

/// The first member outside its domain for this device: no amplitude, one above the device's force limit, too few or too
/// many samples, a delay longer than the duration, a start offset of a transfer function.
[[nodiscard]] std::optional<OptionProblem> find_problem(const RelayOptions& options, const Device& device);

/// One run of the experiment.
struct RelayTrial {
  double start_offset = 0.0;                         ///< m or rad, as varied
  double friction_factor = 1.0;                      ///< what every body's Coulomb friction was multiplied by
  std::vector<double> force;                         ///< of the relay at every sample, N or N m
  std::vector<double> position;                      ///< as measured then, m or rad
  tl::expected<RelayReading, NoOscillation> result;  ///< what was read, or why nothing
};

/// The experiment of section V of Díaz & Gil in simulation: exact device, sampled relay, encoder, friction, delay.
///
/// Each trial multiplies start offset and friction by its own factors, uniform in 1 - variation .. 1 + variation.
/// Trials run in parallel; `progress` may be called from any thread, never from two at once.
/// Only the trials, without what relay() makes of them.
/// Throws Error (invalid_argument) with member and value where find_problem() finds one, (needs_bodies) for a start
/// offset of a transfer function.
[[nodiscard]] std::vector<RelayTrial> relay_trials(const Device& device, const RelayOptions& options,
                                                   const Progress& progress = {});

}  // namespace zwidth
