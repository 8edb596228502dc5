#include "stability/users/disc_stiffness.hpp"

#include <cmath>
#include <limits>

namespace zwidth::internal {

double least_root(double constant, double half, double quadratic) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (constant < 0.0 || (constant == 0.0 && half <= 0.0)) return 0.0;
  const double discriminant = half * half - quadratic * constant;
  if (discriminant < 0.0) return infinity;
  if (half > 0.0) return quadratic < 0.0 ? (std::sqrt(discriminant) + half) / -quadratic : infinity;
  const double denominator = std::sqrt(discriminant) - half;
  return denominator > 0.0 ? constant / denominator : infinity;
}

// With A = |c|² - r²:
//
//     1 + 2 Re[d c] + A |d|² + 2 g (Re[u c] + A Re[u conj d]) + g² A |u|² = 0
GainCondition gain_condition(const TerminationDiscs::Disc& disc, const WallResponse& wall) {
  if (!std::isfinite(disc.radius)) return {-1.0, 0.0, 0.0};  // some user destabilises any wall
  const auto& [unit, closed] = wall;
  return {disc.one + 2.0 * (closed * disc.centre).real() + disc.power * std::norm(closed),
          (unit * disc.centre).real() + disc.power * (unit * std::conj(closed)).real(), disc.power * std::norm(unit)};
}

double least_gain(const TerminationDiscs::Disc& disc, const WallResponse& wall) {
  const GainCondition condition = gain_condition(disc, wall);
  return least_root(condition.constant, condition.half, condition.quadratic);
}

// Lagrange in steps²: nodes 1, 4, 9
double even_parabola(double y1, double y2, double y3, double steps) {
  const double x = steps * steps;
  return y1 * (x - 4.0) * (x - 9.0) / 24.0 - y2 * (x - 1.0) * (x - 9.0) / 15.0 + y3 * (x - 1.0) * (x - 4.0) / 40.0;
}

}  // namespace zwidth::internal
