#pragma once

#include <vector>

#include "stability/gain_locus.hpp"

namespace zwidth::internal {

// A gain kappa > 0 at which closed-loop poles lie on the unit circle.
struct GainCrossing {
  double angle = 0.0;  // [0, pi]; 0 for a real pole at z = 1, pi exactly at Nyquist
  double gain = 0.0;
  int poles_leaving = 0;  // as Crossover::poles_leaving
};

struct GainCrossings {
  std::vector<GainCrossing> crossings;  // by rising angle
  int initially_unstable = 0;           // poles outside the circle for arbitrarily small kappa > 0
};

// Every crossing of the locus.
GainCrossings gain_crossings(const FilteredPlant& plant, const GainLocus& locus);

// Every stiffness crossing with the damper closed, and the poles outside for arbitrarily small K > 0.
GainCrossings stiffness_crossings(const FilteredPlant& plant, const VirtualDamper& damper);

// Poles outside the circle at kappa = gain.
int unstable_poles(const GainCrossings& crossings, double gain);

}  // namespace zwidth::internal
