#include "identification/friction_test.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace zwidth::internal {

std::optional<FrictionEvidence> find_friction(const MotionQuestion& question, std::span<const double> force,
                                              std::span<const double> position) {
  const MotionResiduals residuals(question, force, position);
  if (!residuals.are_enough()) return std::nullopt;
  // Less than this share of the force is what rounds off the record's numbers, where they have no other noise.
  constexpr double least_friction = 1e-6;
  double largest_force = 0.0;
  for (const double each : residuals.force()) largest_force = std::max(largest_force, std::abs(each));
  std::optional<FrictionEvidence> best;
  double best_ratio = 0.0;
  for (const Opposing& each : residuals.opposing_forces([](double) { return 1.0; })) {
    const auto found = residuals.beside(each);
    if (!found) continue;
    const double size = found->values(found->values.size() - 1);
    const double deviation = found->deviations(found->deviations.size() - 1);
    if (size < least_friction * largest_force) continue;
    const double ratio = size / deviation;
    if (best && ratio <= best_ratio) continue;
    best_ratio = ratio;
    best = FrictionEvidence{each.body, size, deviation};
  }
  return best;
}

}  // namespace zwidth::internal
