#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace zwidth {

/// What a simulated loop did, judged from its sensed position alone (as on a real device).
enum class LoopVerdict {
  settles,      ///< the oscillation dies out, or there is none and the device has come to rest
  limit_cycle,  ///< it neither grows nor dies out
  forced,       ///< the same, at the frequency of the user's sine: the user keeps it up
  unstable,     ///< it grows, or passed the divergence bound
  drifts,       ///< no oscillation, but the device moves on
  undecided,    ///< the run is too short to tell
};

inline constexpr double max_simulated_samples = 2e7;  ///< of one simulate()

struct SimulationOptions {
  HybridLoopOptions loop;
  double duration = 1.0;  ///< s; 1 to max_simulated_samples sampling periods
  /// Ends the run as unstable where |sensed position - start| passes this, m or rad.
  double divergence = 1e3;
  std::size_t keep_every = 1;  ///< samples per kept point of the trajectory; 0: none is kept
};

/// Everything at the sampling instants; equal sizes.
struct Trajectory {
  std::vector<double> time;      ///< s
  std::vector<double> measured;  ///< what the encoder gave at that instant, m or rad
  std::vector<double> command;   ///< the force commanded then, N or N m
  std::vector<double> user_force;
  std::vector<std::vector<double>> position;  ///< per body (a transfer function: its output)
  std::vector<std::vector<double>> velocity;  ///< per body
};

/// The oscillation at the end of a run.
struct Oscillation {
  double frequency = 0.0;  ///< rad/s
  double amplitude = 0.0;  ///< half of peak to peak, m or rad
};

struct Simulation {
  Trajectory trajectory;
  LoopVerdict verdict = LoopVerdict::undecided;
  std::optional<Oscillation> oscillation;  ///< at the end of the run; absent where there is none
  /// 1/s, of its envelope over the second half of the run; negative: decays. Absent without an oscillation. Beside a
  /// user's sine: of the loop's own oscillation.
  std::optional<double> growth_rate;
  double final_position = 0.0;    ///< of the sensed body, m or rad
  double peak_penetration = 0.0;  ///< of the sensed body into the wall at the samples, m or rad; 0: none
  /// s, from which on the sensed position stays within 2 % of its largest excursion around its final value; absent
  /// unless it settles.
  std::optional<double> settling_time;
  /// Energy that the sampled wall generated, N m: work of its force on the device, plus what an ideal spring of its
  /// stiffness and force limit would hold at the end, less what it held at the start. Positive: the wall was active.
  /// Absent without a wall.
  std::optional<double> generated_energy;
  double peak_generated_energy = 0.0;  ///< its largest value during the run; 0 at the start
  std::size_t friction_events = 0;
  std::size_t overloaded_steps = 0;  ///< see HybridLoop; 0 in every sound simulation
  std::size_t samples = 0;           ///< simulated; fewer than asked for where it diverged
};

/// Runs the sampled loop for `duration` and judges it, from the start of the user's force on.
///
/// Throws Error (invalid_argument) for options outside their domain, as HybridLoop does. Source of the observer:
/// Hannaford & Ryu 2002 (passivity observer).
[[nodiscard]] Simulation simulate(const Device& device, const SimulationOptions& options,
                                  const Progress& progress = {});

}  // namespace zwidth
