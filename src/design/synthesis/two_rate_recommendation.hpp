#pragma once

#include "zwidth/design/wall_recommendation.hpp"

namespace zwidth::internal {

// recommend_wall() of a device whose damper runs faster in a loop of its own, of WallGoal::stiffness or width. `device`: without
// its wall, not refused, of a loop that knows_all_users(). The margins of gain are those of one rate; that of phase is of the
// spring's force, the damper closed.
[[nodiscard]] WallRecommendation recommend_two_rate_wall(const Device& device, const RecommendationOptions& options);

// The same of WallGoal::damper: the damper in its own loop.
[[nodiscard]] WallRecommendation recommend_two_rate_damper(const Device& device, const RecommendationOptions& options);

// What the damper on the drive would give beside a wall that was found for one rate, with the same margins. `device`: without
// its wall. Nothing as with_damper_on_drive(), and where no such wall is found.
[[nodiscard]] std::optional<DriveDamper> recommend_drive_damper(const Device& device,
                                                                const RecommendationOptions& options,
                                                                const RecommendedWall& found);

}  // namespace zwidth::internal
