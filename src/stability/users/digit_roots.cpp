#include "stability/users/digit_roots.hpp"

#include <algorithm>
#include <utility>

namespace zwidth::internal {
namespace {

/// p(1 + e) by rising powers of e.
void shift_by_one(DigitPolynomial& p) {
  for (std::size_t first = 0; first + 1 < p.size(); ++first) {
    for (std::size_t k = p.size() - 1; k-- > first;) p[k] += p[k + 1];
  }
}

}  // namespace

// N(jw) = E(X) + jw O(X)
DigitPolynomial squared_size(const DigitPolynomial& numerator) {
  DigitPolynomial even{ManyDigits(0.0)};
  DigitPolynomial odd{ManyDigits(0.0)};
  for (std::size_t k = 0; k < numerator.size(); ++k) {
    DigitPolynomial& part = k % 2 == 0 ? even : odd;
    if (k >= 2) part.emplace_back(0.0);
    part.back() = k / 2 % 2 == 0 ? numerator[k] : ManyDigits(-numerator[k]);
  }
  DigitPolynomial square = even * even;
  const DigitPolynomial of_odd = odd * odd;
  square.resize(std::max(square.size(), of_odd.size() + 1), ManyDigits(0.0));
  for (std::size_t k = 0; k < of_odd.size(); ++k) square[k + 1] += of_odd[k];
  return square;
}

DigitPolynomial taylor(DigitPolynomial p, const ManyDigits& x) {
  ManyDigits power = 1.0;
  for (ManyDigits& each : p) {
    each *= power;
    power *= x;
  }
  shift_by_one(p);
  return p;
}

std::size_t multiplicity(const DigitPolynomial& p) {
  ManyDigits largest = 0.0;
  for (const ManyDigits& each : p) largest = std::max<ManyDigits>(largest, abs(each));
  std::size_t count = 0;
  while (count + 1 < p.size() && abs(p[count]) <= zero_in_digits * largest) ++count;
  return count;
}

std::optional<Quadratic> quadratic_factor(const DigitPolynomial& a, Quadratic q) {
  constexpr int most_steps = 40;
  constexpr double settled = 1e-70;  // relative
  const std::size_t n = a.size() - 1;
  if (n == 2) return Quadratic{a[1] / a[2], a[0] / a[2]};
  for (int step = 0; step < most_steps; ++step) {
    DigitPolynomial b(n + 1, ManyDigits(0.0));
    DigitPolynomial f(n + 1, ManyDigits(0.0));
    for (std::size_t i = n - 1; i-- > 0;) {
      b[i] = a[i + 2] - q.u * b[i + 1] - q.v * b[i + 2];
      f[i] = b[i + 2] - q.u * f[i + 1] - q.v * f[i + 2];
    }
    const ManyDigits c = a[1] - q.u * b[0] - q.v * b[1];
    const ManyDigits d = a[0] - q.v * b[0];
    const ManyDigits g = b[1] - q.u * f[0] - q.v * f[1];
    const ManyDigits h = b[0] - q.v * f[0];
    const ManyDigits determinant = q.v * g * g + h * (h - q.u * g);
    if (determinant.is_zero()) return std::nullopt;
    const ManyDigits by_u = (g * d - h * c) / determinant;
    const ManyDigits by_v = ((g * q.u - h) * d - g * q.v * c) / determinant;
    q.u -= by_u;
    q.v -= by_v;
    if (abs(by_u) <= settled * abs(q.u) && abs(by_v) <= settled * abs(q.v)) return q;
  }
  return std::nullopt;
}

std::optional<ManyDigits> multiple_root(const DigitPolynomial& p, std::size_t m, ManyDigits start) {
  constexpr int most_steps = 40;
  constexpr double settled = 1e-80;
  for (int step = 0; step < most_steps; ++step) {
    const DigitPolynomial at = taylor(p, start);
    if (at.size() <= m || at[m].is_zero()) return std::nullopt;
    const ManyDigits change = at[m - 1] / (static_cast<double>(m) * at[m]);
    if (!(abs(change) < 0.5)) return std::nullopt;
    start -= change * start;
    if (abs(change) <= settled) {
      if (multiplicity(taylor(p, start)) != m) return std::nullopt;
      return start;
    }
  }
  return std::nullopt;
}

}  // namespace zwidth::internal
