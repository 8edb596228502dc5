#include "sampling/hold_integrals.hpp"

#include <algorithm>
#include <cmath>

namespace zwidth::internal {
namespace {

// Taylor series of g: (k+2)(k+1) y[k+2] = -c1 (k+1) y[k+1] - c0 y[k], y[2] = 1/2; terms fall like (|pole| t)^k / k!.
HoldIntegrals series(double c1, double c0, double t) {
  constexpr int max_terms = 40;
  double previous = 0.0;         // y[k] t^k
  double current = t * t / 2.0;  // y[k+1] t^(k+1), from k + 1 = 2
  double g = current;
  double h_times_t = 2.0 * current;
  for (int k = 1; k < max_terms; ++k) {
    const double next = -(c1 * t * static_cast<double>(k + 1) * current + c0 * t * t * previous) /
                        static_cast<double>((k + 2) * (k + 1));
    previous = current;
    current = next;
    g += current;
    h_times_t += static_cast<double>(k + 2) * current;
    if (std::abs(current) * static_cast<double>(k + 2) < 1e-18 * std::abs(h_times_t) &&
        std::abs(previous) < 1e-17 * std::abs(g)) {
      break;
    }
  }
  return {h_times_t / t, g};
}

}  // namespace

double decay_integral(double p, double t) { return p == 0.0 ? t : -std::expm1(-p * t) / p; }

HoldIntegrals hold_integrals(double c1, double c0, double t) {
  if (t <= 0.0) return {0.0, 0.0};
  const double sigma = c1 / 2.0;
  if (std::max(std::abs(c1), std::sqrt(std::abs(c0))) * t < 1.0) return series(c1, c0, t);
  const double discriminant = sigma * sigma - c0;
  const double decay = std::exp(-sigma * t);
  if (discriminant < 0.0) {  // 1 - e^{-sigma t}(cos w t + sigma sin w t / w), without cancellation for small angles
    const double w = std::sqrt(-discriminant);
    const double h = decay * std::sin(w * t) / w;
    const double half = std::sin(w * t / 2.0);
    return {h, (-std::expm1(-sigma * t) + 2.0 * decay * half * half - sigma * h) / c0};
  }
  const double kappa = std::sqrt(discriminant);
  if (kappa * t < 0.5) {
    const double h = kappa == 0.0 ? decay * t : decay * std::sinh(kappa * t) / kappa;
    const double half = std::sinh(kappa * t / 2.0);
    return {h, (-std::expm1(-sigma * t) - 2.0 * decay * half * half - sigma * h) / c0};
  }
  // Poles -p1, -p2: h = (e^{-p1 t} - e^{-p2 t}) / (p2 - p1); the smaller one from the product, free of cancellation.
  const double large = sigma + std::copysign(kappa, sigma);
  const double small = c0 / large;
  const double p1 = std::min(large, small);
  const double p2 = std::max(large, small);
  const double h = std::exp(-p1 * t) * -std::expm1(-(p2 - p1) * t) / (p2 - p1);
  return {h, (decay_integral(p1, t) - decay_integral(p2, t)) / (p2 - p1)};
}

}  // namespace zwidth::internal
