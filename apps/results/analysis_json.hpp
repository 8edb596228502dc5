#pragma once

#include "results/json.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::results {

/// The document of `analyze --json`, schema zwidth.analysis/1, keys in their documented order.
///
/// Lengths in m or rad by the device's motion ("units"). What does not exist is null; NaN and infinities never appear.
[[nodiscard]] Json analysis_json(const Device& device, const Analysis& analysis);

}  // namespace zwidth::results
