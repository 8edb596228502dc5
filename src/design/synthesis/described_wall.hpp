#pragma once

#include <string>
#include <utility>

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
inline void add_alternative(RecommendedWall wall, const Trust& trust, WallRecommendation& result) {
  if (trust.refused()) {
    result.trust.doubt({.code = FindingCode::alternative_left_out,
                        .subjects = {{"what", std::string(words_of(wall.kind))}, {"reason", trust.reasons.front()}}});
    return;
  }
  result.trust.inherit(trust);
  result.alternatives.push_back(std::move(wall));
}

// Says that a device without a resolution has no known force per count: a warning where one was asked for.
inline void remark_on_resolution(const Device& device, const RecommendationOptions& options,
                                 WallRecommendation& result) {
  if (device.parameters().sensor.resolution > 0.0) return;
  Finding finding{
      .code = FindingCode::force_per_count_unknown, .subjects = {{"what", "wall"}}, .key = "sensor.resolution"};
  result.remarks.push_back(options.quantisation_force ? warning(std::move(finding)) : note(std::move(finding)));
}

}  // namespace zwidth::internal
