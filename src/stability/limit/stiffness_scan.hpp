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
  int initially_unstable = 0;              // poles outside at the least stiffness, but for one that is at z = 1
};

// A stiffness of at most this one that moves no pole by more than a thousandth of its distance from z = 1, but the one there of a
// position that nothing holds: what happens for arbitrarily small K has happened there.
[[nodiscard]] double soft_stiffness(const ScheduledLoop& loop, double most);

// Every crossing between two stiffnesses, 0 < least < most, or up to where a pole grows a millionfold in the longer period,
// which does not come back: all poles are followed over K, in steps within which each moves
// on a straight line but for less than half its distance from the circle, and each crossing is found to rounding.
// Throws Error (did_not_converge) where that takes too many steps.
[[nodiscard]] ScannedCrossings scan_stiffness(const ScheduledLoop& loop, double least, double most);

}  // namespace zwidth::internal
