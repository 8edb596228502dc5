#pragma once

#include <nlohmann/json.hpp>

#include "report/analysed_device.hpp"

namespace zwidth::report {

/// The document of `analyze --json`, schema zwidth.analysis/1, keys in their documented order.
///
/// Lengths in m or rad by the device's motion ("units"). What does not exist is null; NaN and infinities never appear.
[[nodiscard]] nlohmann::ordered_json analysis_json(const AnalysedDevice& analysed);

}  // namespace zwidth::report
