#pragma once

#include <string>

#include "zwidth/design/wall_recommendation.hpp"

namespace zwidth::report {

/// The wall to render, what bounds it, and the trade-off as a table: at most 100 columns.
[[nodiscard]] std::string wall_recommendation_text(const Device& device, const RecommendationOptions& options,
                                                   const WallRecommendation& recommendation);

}  // namespace zwidth::report
