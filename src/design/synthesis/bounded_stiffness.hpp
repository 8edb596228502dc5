#pragma once

#include <cmath>
#include <vector>

#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/sampling/sampled_plant.hpp"
#include "zwidth/stability/critical_stiffness.hpp"

namespace zwidth::internal {

// What bounds the stiffness of a wall with a given damper, at one rate or two: WallLimits, TwoRateLimits.
struct BoundedStiffness {
  double stiffness = 0.0;  // 0: none; infinite: nothing bounds it
  WallBound bound = WallBound::none;

  void lower_to(double other, WallBound by) {
    if (other < stiffness) *this = {other, by};
  }
};

inline constexpr double off_every_limit = 1e-6;  // relative, of a stiffness that is proposed

inline VirtualDamper scaled(VirtualDamper damper, double factor) {
  return {factor * damper.damping, damper.velocity_filter_hz};
}

// By the gain margin, of the stiffness and of the whole force. limit(damper): the end of the stable stiffnesses from 0 on.
template <typename Limit>
void bound_by_gain(const Limit& limit, VirtualDamper damper, double gain, WallBound bound, BoundedStiffness& least) {
  least.lower_to(limit(damper) / gain, bound);
  for (const double factor : {std::sqrt(gain), gain}) {
    if (damper.damping == 0.0 || least.stiffness == 0.0) return;
    least.lower_to(limit(scaled(damper, factor)) / factor, bound);
  }
}

// By the force of one count of the sensor, where that is asked for and known; `period`: of the damper.
void bound_by_quantisation(const Device& device, double period, VirtualDamper damper,
                           const RecommendationOptions& options, BoundedStiffness& least);

// By the margins of these loops, which are kept then; `damper`: what the plants do not hold of the wall.
void bound_by_margins(const std::vector<FilteredPlant>& plants, VirtualDamper damper,
                      const RecommendationOptions& options, BoundedStiffness& least);

// Whether a wall of that stiffness stays off limit(damper) by the gain margin.
template <typename Limit>
[[nodiscard]] bool keeps_gain(const Limit& limit, double stiffness, VirtualDamper damper, double gain) {
  constexpr double rounding = 1e-9;
  for (const double factor : {1.0, std::sqrt(gain), gain}) {
    const double grown = factor == 1.0 ? gain : factor;
    if (grown * stiffness >= limit(scaled(damper, factor)) * (1.0 + rounding)) return false;
  }
  return true;
}

// Whether it keeps the margins of these loops.
[[nodiscard]] bool keeps_margins(const std::vector<FilteredPlant>& plants, double stiffness, VirtualDamper damper,
                                 const RecommendationOptions& options);

}  // namespace zwidth::internal
