#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/model/state_space.hpp"
#include "zwidth/progress.hpp"
#include "zwidth/sampling/discrete_state_space.hpp"

namespace zwidth {

/// u = -amplitude sign(y), with hysteresis: switches to -amplitude where y rises above it, to +amplitude where y falls
/// below minus it.
struct Relay {
  double amplitude = 0.0;   ///< d, N or N m; > 0
  double hysteresis = 0.0;  ///< m or rad; >= 0
};

/// A symmetric oscillation of a relay loop.
struct LimitCycle {
  double frequency = 0.0;  ///< rad/s
  double amplitude = 0.0;  ///< largest |y| over a period (of samples, for a sampled relay), m or rad
  /// First harmonic of the force over that of the position: the stiffness that a relay experiment reads off.
  double stiffness = 0.0;
};

/// Oscillations that lie side by side: each within a tenth of the next one's frequency.
struct CycleBand {
  std::size_t count = 0;  ///< how many there are
  LimitCycle lowest;      ///< of the lowest frequency
  LimitCycle highest;     ///< of the highest frequency
};

/// `cycles` by rising frequency.
[[nodiscard]] std::vector<CycleBand> cycle_bands(const std::vector<LimitCycle>& cycles);

/// Half-periods of a continuous relay around x' = A x + B u, y = C x with a delay from the switch to the force.
///
///     y(t_switch) = C (I + e^{Ah})^{-1} (e^{A h} - I) A^{-1} B d   at half-period h, without delay
///
/// (with the integral of e^{As} B in place of (e^{Ah} - I) A^{-1} B, so that integrators are allowed). All roots h of
/// "y at the switch = hysteresis" in [shortest, longest] that 4000 log-spaced values bracket, each kept only where y
/// stays beyond its threshold over the whole half-period. By rising frequency. Whether a cycle is stable is not judged.
/// Requires 0 < shortest < longest, delay >= 0; throws Error (invalid_argument) otherwise.
/// Source: Åström 1995; Gonçalves, Megretski, Dahleh 2001.
[[nodiscard]] std::vector<LimitCycle> relay_limit_cycles(const ContinuousStateSpace& system, const Relay& relay,
                                                         double shortest, double longest, double delay = 0.0,
                                                         const Progress& progress = {});

/// Symmetric oscillations of period 2 k samples of a sampled relay, for k = 1..longest.
///
///     x_0 = -(I + F^k)^{-1} sum_{i<k} F^{k-1-i} (G_1 u[i-l] + G_2 u[i-l-1]),   u = d for k samples, -d for the next k
///
/// kept only where the relay, fed with y = C x at every sample, gives exactly that force. By rising frequency;
/// stability is not judged. A sampled relay has many oscillations side by side: which one a device settles at depends
/// on the start.
[[nodiscard]] std::vector<LimitCycle> sampled_relay_limit_cycles(const DiscreteStateSpace& system, const Relay& relay,
                                                                 std::size_t longest, const Progress& progress = {});

/// What first harmonics predict for a sampled relay on the device, one per phase crossover of its sampled plant.
///
///     1 + N(X) P(e^{jwT}) = 0,   N(X) = (4 d / (pi X)) (sqrt(1 - (h/X)^2) - j h/X)
///
/// An approximation. Coulomb friction enters by its own first harmonic, a damping 4 F_c / (pi V) at velocity amplitude
/// V of its body, followed from none to its full level; a cycle of which no balance is left on the way (friction too
/// strong for the relay) has no prediction. A damper that loop.damper runs apart, no slower than the relay, is closed; a
/// slower one, or one beside friction, leaves no prediction. With friction only the 50 softest crossovers are followed: a long delay has
/// thousands. By rising frequency of the cycles without friction.
/// Source: Åström & Hägglund 1995; docs/theory.md, "Formulas of the literature".
[[nodiscard]] std::vector<LimitCycle> describing_function_limit_cycles(const Device& device, const Relay& relay,
                                                                       const Progress& progress = {});

}  // namespace zwidth
