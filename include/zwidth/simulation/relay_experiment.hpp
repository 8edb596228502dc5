#pragma once

#include <cstddef>
#include <cstdint>
#include <tl/expected.hpp>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/simulation/limit_cycle.hpp"
#include "zwidth/simulation/relay_record.hpp"

namespace zwidth {

inline constexpr std::size_t least_relay_samples = 64;         ///< per trial
inline constexpr std::size_t most_relay_samples = 20'000'000;  ///< of all trials together: they are kept

struct RelayExperimentOptions {
  Relay relay;
  double duration = 20.0;     ///< s per trial
  std::size_t trials = 4;     ///< >= 1
  double start_offset = 0.0;  ///< m or rad: all bodies start there at rest
  double variation = 0.05;    ///< relative, in [0, 1): of the start offset and of every friction, drawn per trial
  std::uint64_t seed = 1;     ///< of the variation; equal seeds give equal trials, whatever the number of threads
  std::size_t threads = 0;    ///< 0: as many as the machine has
  RelayAnalysisOptions analysis;
};

struct RelayTrial {
  double start_offset = 0.0;     ///< m or rad, as varied
  double friction_factor = 1.0;  ///< what every body's Coulomb friction was multiplied by
  std::vector<double> force;     ///< commanded at every sample, N or N m
  std::vector<double> position;  ///< as measured then, m or rad
  tl::expected<RelayResult, NoOscillation> result;
};

/// The experiment of section V of Díaz & Gil in simulation: exact device, sampled relay, encoder, friction, delay.
///
/// Each trial multiplies start offset and friction by its own factors, uniform in 1 - variation .. 1 + variation.
/// Trials run in parallel; `progress` may be called from any thread, never from two at once.
/// Throws Error (invalid_argument) for options outside their domain and a delay longer than the duration,
/// (needs_bodies) for a start offset of a transfer function.
[[nodiscard]] std::vector<RelayTrial> relay_experiment(const Device& device, const RelayExperimentOptions& options,
                                                       const Progress& progress = {});

}  // namespace zwidth
