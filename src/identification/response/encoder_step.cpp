#include "identification/response/encoder_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace zwidth::internal {

double encoder_step(std::span<const double> position) {
  double step = std::numeric_limits<double>::infinity();
  double largest = 0.0;
  for (std::size_t k = 1; k < position.size(); ++k)
    largest = std::max(largest, std::abs(position[k] - position[k - 1]));
  constexpr double rounding = 1e-6;
  for (std::size_t k = 1; k < position.size(); ++k) {
    const double change = std::abs(position[k] - position[k - 1]);
    if (change > rounding * largest) step = std::min(step, change);
  }
  if (!std::isfinite(step)) return 0.0;
  constexpr double whole = 0.02;
  constexpr double nearly_all = 0.98;
  std::size_t in_steps = 0;
  for (std::size_t k = 1; k < position.size(); ++k) {
    const double steps = std::abs(position[k] - position[k - 1]) / step;
    if (std::abs(steps - std::round(steps)) < whole) ++in_steps;
  }
  const auto all = static_cast<double>(position.size() - 1);
  return static_cast<double>(in_steps) >= nearly_all * all ? step : 0.0;
}

}  // namespace zwidth::internal
