#pragma once

#include <optional>
#include <vector>

#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/trust.hpp"

namespace zwidth {

/// What oscillates at a crossover: the modal term of largest magnitude at its frequency.
struct Oscillator {
  /// Rigid body or vibration.
  enum class Kind { rigid_body, vibration_mode };
  Kind kind = Kind::rigid_body;  ///< of this one
  int mode = 0;                  ///< number of the vibration mode, from 1; 0 for the rigid body
};

/// A wall stiffness at which a closed-loop pole lies on the unit circle: a phase crossover of the loop.
struct Crossover {
  /// rad/s, in (0, pi/T]; exactly pi/T at Nyquist; 0 where a real pole passes z = 1 (negative static response)
  double frequency = 0.0;
  double stiffness = 0.0;  ///< K > 0
  Oscillator limited_by;   ///< what oscillates there
  /// Poles that leave the unit circle as K rises through this crossover: +2 or -2 (+1, -1 at Nyquist),
  /// 0 where they touch it without crossing.
  int poles_leaving = 0;
};

/// An open interval of K in which the loop is stable.
struct StableInterval {
  double lower = 0.0;           ///< N/m or N m/rad
  std::optional<double> upper;  ///< absent: unbounded
};

/// Whether there is a limit.
enum class StiffnessStatus {
  finite,       ///< stable for 0 < K < stiffness
  none_stable,  ///< unstable for arbitrarily small K > 0; stable intervals may exist further up
  unbounded,    ///< stable for every K > 0
  refused,      ///< no number is given: CriticalStiffness::trust says why
};

/// The stiffest stable virtual wall, with everything that decides it.
struct CriticalStiffness {
  StiffnessStatus status = StiffnessStatus::finite;  ///< whether there is a limit
  double stiffness = 0.0;             ///< K_CR; 0 when none_stable, infinity when unbounded, NaN when refused
  std::optional<Crossover> limit;     ///< the crossover at K_CR; absent unless finite
  std::vector<Crossover> crossovers;  ///< all, by rising frequency
  std::vector<StableInterval> stable_intervals;  ///< all, by rising K
  Trust trust = {};  ///< of the device and of the computation; where refused, all above is empty
};

/// The virtual damper that stays closed while K varies: B v(z) as in Wall.
struct VirtualDamper {
  double damping = 0.0;             ///< B >= 0
  double velocity_filter_hz = 0.0;  ///< f_c >= 0; 0: none
};

/// That of the device's own wall.
[[nodiscard]] VirtualDamper virtual_damper(const Device& device);

/// The critical stiffness of a device with its own wall's damper and filters closed: the entry point.
///
/// Computed by the function below, then checked by a second route that shares nothing with it (matrix exponential,
/// closed-loop poles): the number of poles outside the unit circle just below and just above K_CR. Where the two
/// contradict, where the device's own numbers are refused (trust_of()), or where the search for crossovers hits its cap,
/// the answer is `refused` and holds no number; what is doubtful stays so.
/// Throws Error (did_not_converge) as modal_form() does.
[[nodiscard]] CriticalStiffness critical_stiffness(const Device& device);

/// Finds every K > 0 at which 1 + (K + B v(z)) P(z) = 0 has a root on the unit circle, and from them K_CR.
///
/// Complete: the phase condition is isolated by interval subdivision of 0..Nyquist with bounds on its second derivative
/// (see docs/completeness.md); no grid is involved. Each root is polished to rounding. The number of unstable poles
/// between crossovers follows from the direction of every crossing.
/// The trust stays sound: this route is not checked by another, nor does a plant know where its numbers come from.
/// Throws Error (invalid_argument) for negative or non-finite B or f_c, (did_not_converge) when subdivision hits its
/// cap. Source: eqs. 21-23, 27-28 of Díaz & Gil; docs/theory.md, "Critical stiffness".
[[nodiscard]] CriticalStiffness critical_stiffness(const FilteredPlant& plant, VirtualDamper damper = {});

}  // namespace zwidth
