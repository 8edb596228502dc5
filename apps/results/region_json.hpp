#pragma once

#include "report/device_region.hpp"
#include "results/json.hpp"

namespace zwidth::report {

/// The answer of `region --json`, schema zwidth.region/1 (docs/region.md).
[[nodiscard]] results::Json region_json(const DeviceRegion& device);

}  // namespace zwidth::report
