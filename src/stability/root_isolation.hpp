#pragma once

// All roots of the phase condition on (0, pi), by subdivision with first-order Taylor models; see docs/completeness.md.

#include <vector>

#include "stability/gain_locus.hpp"

namespace zwidth {

struct PhaseRoot {
  double angle = 0.0;
  // Sign change of f: +1 from negative to positive, -1 the other way; 0: f touches zero, to rounding, without a change.
  int direction = 0;
};

// Throws Error (did_not_converge) past a cap on the number of intervals.
std::vector<PhaseRoot> phase_roots(const GainLocus& locus);

}  // namespace zwidth
