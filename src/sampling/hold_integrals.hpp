#pragma once

namespace zwidth::internal {

// Impulse and step response of 1/(s² + c1 s + c0) at time t: h(t) and g(t), the integral of h. They obey
// h' + c1 h + c0 g = 1.
struct HoldIntegrals {
  double h = 0.0;
  double g = 0.0;
};

// To full relative accuracy for small and large |pole| t, light, critical and heavy damping, c0 = 0 included.
HoldIntegrals hold_integrals(double c1, double c0, double t);

// (1 - e^{-p t}) / p, t at p = 0.
double decay_integral(double p, double t);

}  // namespace zwidth::internal
