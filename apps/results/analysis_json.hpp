#pragma once

#include <optional>

#include "results/json.hpp"
#include "zwidth/design/wall_summary.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::results {

/// The document of `analyze --json`, schema zwidth.analysis/1, keys in their documented order.
///
/// "walls" is null where they were not asked for. Lengths in m or rad by the device's motion ("units"). What does not exist is null; NaN and infinities never appear.
[[nodiscard]] Json analysis_json(const Device& device, const Analysis& analysis,
                                 const std::optional<WallSummary>& walls = {});

}  // namespace zwidth::results
