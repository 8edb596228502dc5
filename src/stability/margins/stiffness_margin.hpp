#pragma once

#include <algorithm>
#include <optional>
#include <vector>

namespace zwidth::internal {

// The least factor above 1 on K alone that takes it to a crossing.
template <typename Crossing>
[[nodiscard]] std::optional<double> stiffness_margin(const std::vector<Crossing>& crossings, double Crossing::*critical,
                                                     double stiffness) {
  std::optional<double> least;
  for (const Crossing& each : crossings) {
    const double factor = each.*critical / stiffness;
    if (factor > 1.0) least = std::min(least.value_or(factor), factor);
  }
  return least;
}

}  // namespace zwidth::internal
