#pragma once

// Ehrlich-Aberth iteration: all roots of p at once, quadratically or better, from p / p' alone.
// Source: O. Aberth 1973; D. Bini and V. Noferini 2013 for p = det of a matrix polynomial.

#include <cstddef>
#include <vector>

#include "model/extended_precision.hpp"

namespace zwidth::internal {

// Improves `roots` in place until every step is below `tolerance` relative, or `max_sweeps` is reached.
// Returns the largest relative step of the last sweep.
template <typename Real, typename Pencil>
double improve_roots(const Pencil& pencil, std::vector<Complex<Real>>& roots, double tolerance, int max_sweeps) {
  double largest = 0.0;
  std::vector<char> done(roots.size(), 0);
  for (int sweep = 0; sweep < max_sweeps; ++sweep) {
    largest = 0.0;
    for (std::size_t i = 0; i < roots.size(); ++i) {
      if (done[i]) continue;
      const Complex<Real> newton = pencil.newton_step(roots[i]);
      const double newton_size = magnitude(newton);
      const double size = magnitude(roots[i]);
      if (!std::isfinite(newton_size)) {  // p is zero here, to rounding
        done[i] = 1;
        continue;
      }
      // step = N / (1 - N sum_j 1/(z_i - z_j)), N = p/p'
      Complex<Real> repulsion;
      for (std::size_t j = 0; j < roots.size(); ++j) {
        if (j == i) continue;
        const Complex<Real> gap = roots[i] - roots[j];
        if (magnitude(gap) > 0.0) repulsion += Complex<Real>(Real(1.0)) / gap;
      }
      Complex<Real> denominator = Complex<Real>(Real(0.0)) - newton * repulsion;
      denominator.re += Real(1.0);
      const Complex<Real> step = magnitude(denominator) > 0.0 ? newton / denominator : newton;
      roots[i] -= step;
      const double relative = magnitude(step) / size;
      if (relative <= tolerance) done[i] = 1;
      largest = std::max(largest, relative);
    }
    if (largest <= tolerance) break;
  }
  return largest;
}

}  // namespace zwidth::internal
