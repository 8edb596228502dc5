#pragma once

#include <optional>
#include <vector>

#include "zwidth/model/device.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// A virtual damping at which a closed-loop pole lies on the unit circle, K = 0.
struct DampingCrossover {
  double frequency = 0.0;  ///< rad/s, as Crossover::frequency
  double damping = 0.0;    ///< B > 0
  Oscillator limited_by;   ///< what oscillates there
  int poles_leaving = 0;   ///< as B rises, as Crossover::poles_leaving
};

/// The largest stable virtual damper without a spring, with everything that decides it.
struct CriticalDamping {
  StiffnessStatus status = StiffnessStatus::finite;  ///< of B: whether there is a limit
  double damping = 0.0;                              ///< 0 when none_stable, infinity when unbounded, NaN when refused
  std::optional<DampingCrossover> limit;             ///< the crossover at `damping`; absent unless finite
  std::vector<DampingCrossover> crossovers;          ///< all, by rising frequency
  std::vector<StableInterval> stable_intervals;      ///< of B, all, rising
  Trust trust;  ///< of the device and of the computation; where refused, all above is empty
};

/// The upper end of the dampers from 0 on with which the loop is stable at K = 0, the device's own [operator] holding.
///
///     1 + B v(z) P(z) = 0,   v as in Wall
///
/// Every crossover is found as in critical_stiffness(). The pole at z = 1 of a position that nothing holds is no
/// instability. The pole count of a second route (closed-loop poles of the matrix exponential) just below and just above B
/// confirms the limit; where they contradict, it is `refused`.
/// Throws Error (did_not_converge) as modal_form() does.
[[nodiscard]] CriticalDamping critical_damping(const Device& device);

/// The largest damper without a spring that no passive user destabilises.
struct AbsoluteStabilityDamping {
  double damping = 0.0;        ///< every B below is stable with every passive user; 0: none is; infinite: all are
  double frequency = 0.0;      ///< rad/s, as AbsoluteStabilityLimit::frequency
  double truncation = 0.0;     ///< relative, taken off, as AbsoluteStabilityLimit::truncation
  bool needs_no_user = false;  ///< the device that nobody holds reaches it
  Trust trust;                 ///< doubtful where more than 1e-4 had to be taken off
};

/// absolute_stability_limit() of the damper alone: the least B that breaks
///
///     |1 + B v c_T| > |B v| r_T      at some 0 < w <= pi/T
///
/// with the discs c_T, r_T of absolute_stability_limit(). A rigid device without delay: its own damping b (Colgate & Schenkel).
/// Throws Error (needs_bodies) for a transfer function, and what critical_damping() throws.
[[nodiscard]] AbsoluteStabilityDamping absolute_stability_damping(const Device& device, const Progress& progress = {});

}  // namespace zwidth
