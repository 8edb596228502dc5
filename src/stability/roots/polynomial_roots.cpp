#include "stability/roots/polynomial_roots.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace zwidth::internal {
namespace {

using LongComplex = std::complex<long double>;

constexpr int most_sweeps_of_roots = 80;
constexpr long double farthest = 0.7L;        // that a root moves in a sweep, of itself
constexpr long double root_settled = 1e-17L;  // relative

/// Start values: on circles whose radii are the slopes of the upper hull of log |c_k| over k, evenly on each.
std::vector<LongComplex> start_of_roots(const std::vector<long double>& c) {
  std::vector<std::size_t> hull;
  const auto height = [&](std::size_t k) { return std::log(std::abs(c[k])); };
  for (std::size_t k = 0; k < c.size(); ++k) {
    if (c[k] == 0.0L) continue;
    while (hull.size() >= 2) {
      const std::size_t a = hull[hull.size() - 2];
      const std::size_t b = hull.back();
      const auto rise = [&](std::size_t from, std::size_t to) {
        return (height(to) - height(from)) / static_cast<long double>(to - from);
      };
      if (rise(a, b) > rise(b, k)) break;
      hull.pop_back();
    }
    hull.push_back(k);
  }
  std::vector<LongComplex> roots;
  for (std::size_t i = 0; i + 1 < hull.size(); ++i) {
    const auto count = static_cast<long double>(hull[i + 1] - hull[i]);
    const long double radius = std::exp((height(hull[i]) - height(hull[i + 1])) / count);
    for (std::size_t k = hull[i]; k < hull[i + 1]; ++k) {
      const long double turn = 2.0L * std::numbers::pi_v<long double> * static_cast<long double>(k - hull[i]) / count +
                               0.7L + 0.4L * static_cast<long double>(i);
      roots.push_back(std::polar(radius, turn));
    }
  }
  return roots;
}

/// p/p' at x.
LongComplex newton_step(const std::vector<long double>& c, const LongComplex& x) {
  const std::size_t degree = c.size() - 1;
  LongComplex value = 0.0L;
  LongComplex slope = 0.0L;
  for (std::size_t k = degree + 1; k-- > 0;) {
    slope = slope * x + value;
    value = value * x + c[k];
  }
  return slope == LongComplex(0.0L) ? LongComplex(0.0L) : value / slope;
}

}  // namespace

std::vector<std::complex<long double>> polynomial_roots(const std::vector<long double>& coefficients) {
  std::vector<LongComplex> roots = start_of_roots(coefficients);
  for (int sweep = 0; sweep < most_sweeps_of_roots; ++sweep) {
    bool all_settled = true;
    for (std::size_t i = 0; i < roots.size(); ++i) {
      const LongComplex step = newton_step(coefficients, roots[i]);
      LongComplex repelled = 0.0L;
      for (std::size_t j = 0; j < roots.size(); ++j) {
        if (j != i && roots[i] != roots[j]) repelled += 1.0L / (roots[i] - roots[j]);
      }
      LongComplex change = step / (1.0L - step * repelled);
      if (!std::isfinite(change.real()) || !std::isfinite(change.imag())) change = 0.1L * step;
      const long double size = std::abs(change);
      if (size > farthest * std::abs(roots[i])) change *= farthest * std::abs(roots[i]) / size;
      roots[i] -= change;
      all_settled = all_settled && std::abs(change) <= root_settled * std::abs(roots[i]);
    }
    if (all_settled) break;
  }
  return roots;
}

}  // namespace zwidth::internal
