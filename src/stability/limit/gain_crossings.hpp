#pragma once

#include <vector>

#include "stability/limit/gain_locus.hpp"

namespace zwidth::internal {

// A gain kappa > 0 at which closed-loop poles lie on the unit circle.
struct GainCrossing {
  double angle = 0.0;  // [0, pi]; 0 for a real pole at z = 1, pi exactly at Nyquist
  double gain = 0.0;
  int poles_leaving = 0;  // as Crossover::poles_leaving
  double noise = 0.0;     // bound of the gain's rounding, and of that of the plant's coefficients
};

struct GainCrossings {
  std::vector<GainCrossing> crossings;  // by rising angle
  int initially_unstable = 0;           // poles outside the circle for arbitrarily small kappa > 0
};

// Every crossing of the locus.
GainCrossings gain_crossings(const FilteredPlant& plant, const GainLocus& locus);

// Every crossing of the damper alone, K = 0. Its B does not matter.
GainCrossings damping_crossings(const FilteredPlant& plant, const VirtualDamper& damper);

// Every stiffness crossing with the damper closed, and the poles outside for arbitrarily small K > 0.
GainCrossings stiffness_crossings(const FilteredPlant& plant, const VirtualDamper& damper);
// The same where the crossings of the damper alone are known: for many B.
GainCrossings stiffness_crossings(const FilteredPlant& plant, const VirtualDamper& damper,
                                  const GainCrossings& by_damping);

// Those of at most `most` > 0: only the frequencies are isolated at which so soft a wall can be critical.
GainCrossings stiffness_crossings_up_to(const FilteredPlant& plant, const VirtualDamper& damper, double most);

// The critical stiffness that these stiffness crossings say.
CriticalStiffness critical_stiffness_of(const FilteredPlant& plant, const GainCrossings& crossings);
// The same where another plant, of the same period, has the terms that crossovers are named by.
CriticalStiffness critical_stiffness_of(const FilteredPlant& plant, const GainCrossings& crossings,
                                        const SampledPlant& modes);
// Fills in what follows from the crossovers and the poles outside for arbitrarily small K > 0: the stable intervals and the
// limit.
void find_limit(CriticalStiffness& critical, int initially_unstable);

// The end of the stable stiffnesses from 0 on where it is at most `most` > 0, else `most`; infinite where nothing bounds it
// and `most` is. By stiffness_crossings_up_to().
[[nodiscard]] double stiffness_limit(const FilteredPlant& plant, const VirtualDamper& damper, double most);

// Poles outside the circle at kappa = gain.
int unstable_poles(const GainCrossings& crossings, double gain);

}  // namespace zwidth::internal
