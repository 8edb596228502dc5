#pragma once

#include "design/synthesis/wall_check.hpp"
#include "staged_progress.hpp"
#include "zwidth/design/wall_recommendation.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth::internal {

// The wall of `walled` with its margins and limits, checked by the second route; what contradicts is refused in `trust`, and the
// wall is then incomplete. `bound`: of its stiffness. Limits: WallLimits or TwoRateLimits.
template <typename Limits>
[[nodiscard]] RecommendedWall described_wall(RecommendedWall::Kind kind, const Device& walled, WallBound bound,
                                             Limits& limits, const RecommendationOptions& options, Trust& trust) {
  RecommendedWall wall;
  wall.kind = kind;
  wall.wall = walled.parameters().wall;
  const VirtualDamper damper{wall.wall.damping, wall.wall.velocity_filter_hz};
  tell(options.progress, 0.0);
  check_wall(walled, options, limits.has_users(), trust);
  if (trust.refused()) return wall;
  if (!limits.keeps(*wall.wall.stiffness, damper)) {
    trust.refuse({.code = FindingCode::wall_margins_contradict, .subjects = {{"what", "wall"}}});
    return wall;
  }
  wall.bounded_by.stiffness = bound;
  tell(options.progress, 0.0);
  wall.margins = wall_margins(walled);
  tell(options.progress, 0.0);
  if (limits.has_users()) {
    wall.absolute_stability_limit = limits.limit(damper);
    wall.absolute_stability_margin = *wall.absolute_stability_limit / *wall.wall.stiffness;
  }
  wall.force_per_count = force_per_count(walled);
  return wall;
}

// Puts a described wall among the alternatives; a refused one leaves a doubt that names it.
void add_alternative(RecommendedWall wall, const Trust& trust, WallRecommendation& result);

// Says that a device without a resolution has no known force per count: a warning where one was asked for.
void remark_on_resolution(const Device& device, const RecommendationOptions& options, WallRecommendation& result);

}  // namespace zwidth::internal
