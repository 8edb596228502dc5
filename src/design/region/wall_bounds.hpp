#pragma once

#include "design/region/boundary_curve.hpp"

namespace zwidth::internal {

// A part of the (K, B) plane that holds every stable wall.
struct CurveBounds {
  double stiffness = 0.0;  // >= every stable K
  double damping = 0.0;    // >= every stable B
};

// From what holds for every polynomial c(z) of degree N, monic, with all roots p inside the unit circle, here
// c = z^L D (z - a) (1 + w), w = (K + B v) P:
//
//     |c| <= 2^N on |z| = 1            so  |w| <= 2^N / |D (z - a)| + 1
//     d arg c/dt = sum Re z/(z - p) >= N/2  at every z = e^{jt}: with a long delay arg(1 + w) falls too fast
//                                          where |w| > 1
//     c(-1) (-1)^N > 0                 so  K + B v(-1) stays below the Nyquist line
//
// Each bounds |K + B v| at some z, which is at least K and at least B |v|. Infinite where nothing follows.
CurveBounds wall_bounds(const BoundaryCurve& curve);

}  // namespace zwidth::internal
