#pragma once

#include <complex>

#include "stability/loop/damper_response.hpp"
#include "stability/users/termination_discs.hpp"

namespace zwidth::internal {

/// The least K > 0 with constant + 2 half K + quadratic K² = 0; 0 for a constant < 0, and for 0 where the
/// sum is negative beside K = 0; infinity where there is none.
[[nodiscard]] double least_root(double constant, double half, double quadratic);

/// constant + 2 half g + quadratic g² > 0: no plant of the disc is at the verge with the gain g. A finite radius.
struct GainCondition {
  double constant = 1.0;
  double half = 0.0;
  double quadratic = 0.0;
};
[[nodiscard]] GainCondition gain_condition(const TerminationDiscs::Disc& disc, const WallResponse& wall);

/// The least g > 0 with |1 + (g u + d) c| = |g u + d| r; infinity where there is none (1: disc.one).
[[nodiscard]] double least_gain(const TerminationDiscs::Disc& disc, const WallResponse& wall);

/// The same of the stiffness, u = 1, where `damper` is B v.
[[nodiscard]] inline double least_stiffness(const TerminationDiscs::Disc& disc, std::complex<double> damper) {
  return least_gain(disc, {1.0, damper});
}

/// Relative, of a fourth sample from the parabola through three: the function is smooth enough to extrapolate to 0.
inline constexpr double smooth_enough = 1e-6;

/// The value at `steps` of an even function's parabola through its values at 1, 2 and 3 steps.
[[nodiscard]] double even_parabola(double y1, double y2, double y3, double steps);

}  // namespace zwidth::internal
