#pragma once

#include <complex>
#include <vector>

#include "stability/second_route/scheduled_loop.hpp"

namespace zwidth::internal {

// A stiffness at which a pole of the loop over its longer period lies on the unit circle.
struct ScannedCrossing {
  double stiffness = 0.0;
  std::complex<double> pole_minus_one;  // imaginary part >= 0
  int poles_leaving = 0;                // as Crossover::poles_leaving
};

struct ScannedCrossings {
  std::vector<ScannedCrossing> crossings;  // by rising stiffness
  int initially_unstable = 0;              // poles outside at the least stiffness, without one at z = 1
};

// A stiffness, at most this one, so soft that every pole still lies where K = 0 has it, to a thousandth of its distance from
// z = 1; the pole at z = 1 of a position that nothing holds is left out. A softer spring changes no pole count.
[[nodiscard]] double soft_stiffness(const ScheduledLoop& loop, double most);

// Every crossing between two stiffnesses, 0 < least < most. All poles are followed over K. A step is short enough when each
// pole deviates from a straight line by less than half its distance from the circle; each crossing is found to rounding.
// Ends at the stiffness at which a pole grows a millionfold in the longer period: it does not come back.
// Throws Error (did_not_converge) where that takes too many steps.
[[nodiscard]] ScannedCrossings scan_stiffness(const ScheduledLoop& loop, double least, double most);

}  // namespace zwidth::internal
