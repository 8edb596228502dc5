#pragma once

#include "report/identified_device.hpp"
#include "results/json.hpp"

namespace zwidth::report {

enum class PointsInJson { left_out, included };

/// {"key", "value", "unit", "identifiable", "standard_deviation", "interval"}; null for what does not exist.
[[nodiscard]] results::Json estimate_json(const ParameterEstimate& estimate, Motion motion);

/// The document of `identify --json`, schema zwidth.identification/1 (docs/identification.md).
[[nodiscard]] results::Json identification_json(const IdentifiedDevice& identified, PointsInJson points);

}  // namespace zwidth::report
