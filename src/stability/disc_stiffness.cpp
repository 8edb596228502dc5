#include "stability/disc_stiffness.hpp"

#include <cmath>
#include <limits>

namespace zwidth::internal {

// With A = |c|² - r²:
//
//     K² A + 2 K (Re c + A Re[B v]) + 1 + 2 Re[B v c] + A |B v|² = 0
double least_stiffness(const UserDiscs::Disc& disc, std::complex<double> damper) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!std::isfinite(disc.radius)) return 0.0;
  const double half = -disc.centre.real() - disc.power * damper.real();
  const double constant = 1.0 + 2.0 * (damper * disc.centre).real() + disc.power * std::norm(damper);
  if (constant <= 0.0) return 0.0;
  const double discriminant = half * half - disc.power * constant;
  if (discriminant < 0.0) return infinity;
  const double denominator = half + std::sqrt(discriminant);
  return denominator > 0.0 ? constant / denominator : infinity;
}

// Lagrange in steps²: nodes 1, 4, 9
double even_parabola(double y1, double y2, double y3, double steps) {
  const double x = steps * steps;
  return y1 * (x - 4.0) * (x - 9.0) / 24.0 - y2 * (x - 1.0) * (x - 9.0) / 15.0 + y3 * (x - 1.0) * (x - 4.0) / 40.0;
}

}  // namespace zwidth::internal
