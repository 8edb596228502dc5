#include "sampling/hold_integrals.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fifty_digits.hpp"

namespace zwidth {
using namespace internal;
namespace {

using test::Complex50;
using test::Real50;

struct Exact {
  Real50 h;
  Real50 g;
};

// By the matrix exponential of [[0, 1, 0], [-c0, -c1, 1], [0, 0, 0]].
Exact exact_integrals(double c1, double c0, double t) {
  auto generator = test::zeros<Real50>(3, 3);
  generator[0][1] = 1;
  generator[1][0] = -Real50(c0);
  generator[1][1] = -Real50(c1);
  generator[1][2] = 1;
  const auto e = test::exponential(generator, Real50(t));
  return {e[1][2], e[0][2]};
}

// h passes through zero where it oscillates: its error counts relative to its envelope e^{-c1 t/2}/w, too.
void expect_exact(double c1, double c0, double t) {
  const HoldIntegrals ours = hold_integrals(c1, c0, t);
  const Exact exact = exact_integrals(c1, c0, t);
  const double w_squared = c0 - c1 * c1 / 4.0;
  const double envelope = w_squared > 0.0 ? std::exp(-c1 * t / 2.0) / std::sqrt(w_squared) : 0.0;
  // An angle w t of k turns is known to k rounding units.
  const double rounding = 1e-14 * (1.0 + std::sqrt(std::abs(w_squared)) * t);
  const auto error = [](double value, const Real50& reference) {
    return static_cast<double>(abs(Real50(value) - reference));
  };
  const double h_size = static_cast<double>(abs(exact.h));
  // fifty digits of e^{A t} leave 1e-48 or so
  EXPECT_LE(error(ours.h, exact.h), rounding * std::max(h_size, envelope) + 1e-48) << c1 << " " << c0 << " " << t;
  EXPECT_LE(error(ours.g, exact.g), rounding * static_cast<double>(abs(exact.g))) << c1 << " " << c0 << " " << t;
}

TEST(HoldIntegrals, LightCriticalAndHeavyDamping) {
  for (const double w : {1e-3, 1.0, 50.0, 600.0, 1e4}) {
    for (const double zeta : {0.0, 1e-6, 0.01, 0.5, 0.999999, 1.0, 1.000001, 1.1, 3.0, 300.0}) {
      for (const double t : {1e-6, 1e-4, 1e-3, 1e-2}) expect_exact(2.0 * zeta * w, w * w, t);
    }
  }
}

TEST(HoldIntegrals, WithoutStiffness) {
  for (const double c1 : {0.0, 1e-6, 0.6, 50.0, 1e4}) {
    for (const double t : {1e-6, 1e-3, 1e-2}) expect_exact(c1, 0.0, t);
  }
}

TEST(HoldIntegrals, PolesOnTheRight) {
  for (const double t : {1e-3, 1e-1, 1.0, 5.0}) {
    expect_exact(-2.0, 5.0, t);
    expect_exact(-1.0, -2.0, t);
    expect_exact(1.0, -2.0, t);
    expect_exact(0.0, -4.0, t);
    expect_exact(-2.0, 1.0, t);
    expect_exact(-3.0, 0.0, t);
  }
}

TEST(HoldIntegrals, SwitchesBetweenItsFormulasWithoutAStep) {
  for (const double x : {0.999999, 1.000001}) {  // |pole| t = 1
    expect_exact(0.1 * x, x * x, 1.0);
    expect_exact(x, 0.2 * x * x, 1.0);
  }
  for (const double kappa : {0.499999, 0.500001}) expect_exact(4.0, 4.0 - kappa * kappa, 1.0);
}

TEST(HoldIntegrals, NoTimeNoIntegral) {
  EXPECT_EQ(hold_integrals(1.0, 2.0, 0.0).h, 0.0);
  EXPECT_EQ(hold_integrals(1.0, 2.0, 0.0).g, 0.0);
  EXPECT_EQ(decay_integral(0.0, 0.3), 0.3);
  EXPECT_NEAR(decay_integral(1e-12, 0.3), 0.3 - 0.5 * 1e-12 * 0.09, 1e-16);
  EXPECT_NEAR(decay_integral(2.0, 1.0), (1.0 - std::exp(-2.0)) / 2.0, 1e-16);
}

}  // namespace
}  // namespace zwidth
