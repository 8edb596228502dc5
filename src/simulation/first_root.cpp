#include "simulation/first_root.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace zwidth::internal {
namespace {

constexpr std::size_t max_coefficients = 32;
constexpr int max_depth = 50;  // halvings: below that the interval is one point of double
constexpr int max_iterations = 100;
constexpr double none = 2.0;
constexpr double near = 1e-8;  // a step of Newton's, relative: the next is its square

using Coefficients = std::array<double, max_coefficients>;

/// Of b_i = sum_k C(i, k) / C(n, k) a_k by n + 1, the number of coefficients: for each i those of k <= i.
using BernsteinWeights = std::array<double, max_coefficients*(max_coefficients + 1) / 2>;
constexpr std::array<BernsteinWeights, max_coefficients + 1> make_bernstein_weights() noexcept {
  std::array<BernsteinWeights, max_coefficients + 1> weights{};
  for (std::size_t count = 1; count <= max_coefficients; ++count) {
    const std::size_t n = count - 1;
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      double weight = 1.0;
      for (std::size_t k = 0; k <= i; ++k) {
        weights[count][at++] = weight;
        if (k < n) weight *= static_cast<double>(i - k) / static_cast<double>(n - k);
      }
    }
  }
  return weights;
}
constexpr std::array<BernsteinWeights, max_coefficients + 1> bernstein_weights = make_bernstein_weights();

/// The one root in [lower, upper], where the polynomial falls from `first` >= 0 to `last` < 0: Newton, kept in its
/// bracket, from where the chord crosses zero.
double polish(std::span<const double> power, double lower, double upper, double first, double last) noexcept {
  double s = lower + (upper - lower) * (first / (first - last));
  if (!(s > lower && s < upper)) s = 0.5 * (lower + upper);
  bool was_near = false;
  for (int i = 0; i < max_iterations; ++i) {
    double value = 0.0;
    double slope = 0.0;
    for (std::size_t k = power.size(); k-- > 0;) {
      slope = slope * s + value;
      value = value * s + power[k];
    }
    (value >= 0.0 ? lower : upper) = s;
    const double step = value / slope;
    const bool is_near = std::abs(step) <= near * s;
    // The second near step is of rounding alone: which side of the root it is on says nothing.
    if (is_near && was_near) return std::clamp(s - step, lower, upper);
    was_near = is_near;
    s -= step;
    if (!(s > lower && s < upper)) s = 0.5 * (lower + upper);
  }
  return s;
}

double search(std::span<const double> power, const Coefficients& bernstein, double lower, double upper,
              int depth) noexcept {
  const std::size_t count = power.size();
  if (bernstein[0] < 0.0) return lower;
  int changes = 0;
  bool negative = false;
  for (std::size_t k = 0; k < count; ++k) {
    if (bernstein[k] == 0.0 || (bernstein[k] < 0.0) == negative) continue;
    negative = !negative;
    ++changes;
  }
  if (changes == 0) return none;
  if (depth == max_depth) return lower;
  if (changes == 1) return polish(power, lower, upper, bernstein[0], bernstein[count - 1]);
  // de Casteljau at the middle
  Coefficients left{};
  Coefficients right = bernstein;
  for (std::size_t k = 0; k < count; ++k) {
    left[k] = right[0];
    for (std::size_t i = 0; i + 1 < count - k; ++i) right[i] = 0.5 * (right[i] + right[i + 1]);
  }
  // After the loop right[i] holds the i-th level's last value: exactly the right half, read from its start.
  const double middle = 0.5 * (lower + upper);
  const double found = search(power, left, lower, middle, depth + 1);
  return found <= 1.0 ? found : search(power, right, middle, upper, depth + 1);
}

}  // namespace

double first_turn_negative(std::span<const double> coefficients) noexcept {
  const std::size_t count = coefficients.size();
  if (count == 0) return none;
  // Most are dismissed, or known to be monotone, by the size of their coefficients alone.
  double sum = 0.0;
  double others = 0.0;
  double slopes = 0.0;
  for (std::size_t k = 1; k < count; ++k) {
    sum += coefficients[k];
    others += std::abs(coefficients[k]);
    if (k > 1) slopes += static_cast<double>(k) * std::abs(coefficients[k]);
  }
  if (coefficients[0] < 0.0) return 0.0;
  if (coefficients[0] >= others) return none;
  if (count > 1 && std::abs(coefficients[1]) > slopes) {
    const double last = coefficients[0] + sum;
    return last >= 0.0 ? none : polish(coefficients, 0.0, 1.0, coefficients[0], last);
  }
  Coefficients bernstein{};
  const double* weight = bernstein_weights[count].data();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k <= i; ++k) bernstein[i] += *weight++ * coefficients[k];
  }
  return search(coefficients, bernstein, 0.0, 1.0, 0);
}

}  // namespace zwidth::internal
