#pragma once

#include <nlohmann/json.hpp>

#include "report/device_region.hpp"

namespace zwidth::report {

/// The answer of `region --json`, schema zwidth.region/1 (docs/region.md).
[[nodiscard]] nlohmann::ordered_json region_json(const DeviceRegion& device);

}  // namespace zwidth::report
