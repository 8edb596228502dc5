#pragma once

#include "zwidth/design/wall_recommendation.hpp"

namespace zwidth::internal {

/// recommend_wall() without its `limits`, for who has them.
[[nodiscard]] WallRecommendation recommended_wall(const Device& device, const RecommendationOptions& options);

}  // namespace zwidth::internal
