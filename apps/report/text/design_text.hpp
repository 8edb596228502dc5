#pragma once

#include <string>

#include "zwidth/design/design.hpp"
#include "zwidth/design/design_comparison.hpp"
#include "zwidth/design/design_target.hpp"
#include "zwidth/design/notch_design.hpp"
#include "zwidth/design/parameter_sweep.hpp"
#include "zwidth/design/wall_recommendation.hpp"

namespace zwidth::report {

/// What limits the device and what every one of its numbers does to it: at most 100 columns, the strongest first.
[[nodiscard]] std::string design_text(const Device& device, const Design& design);

/// A row per variant, and a sentence per user that says which is better.
[[nodiscard]] std::string comparison_text(const DesignComparison& comparison);

/// What each number alone would have to be, the cheapest first: at most 100 columns.
[[nodiscard]] std::string design_target_text(const Device& device, const DesignTargetOptions& options,
                                             const DesignTargets& targets);

/// The answer for people: what to paste, what it gains over the modal shifts, what it costs.
[[nodiscard]] std::string notch_text(const Device& device, const NotchOptions& options, const NotchDesign& notch);

/// The sweep as a table: every point of one parameter up to `most_rows`, evenly thinned beyond; of two, the least and
/// the largest K_CR with where they lie.
[[nodiscard]] std::string sweep_text(const Device& device, const ParameterSweep& sweep);

/// The wall to render, what bounds it, and the trade-off as a table: at most 100 columns.
[[nodiscard]] std::string wall_recommendation_text(const Device& device, const RecommendationOptions& options,
                                                   const WallRecommendation& recommendation);

}  // namespace zwidth::report
