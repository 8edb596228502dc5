#pragma once

#include <string>

#include "report/device_region.hpp"

namespace zwidth::report {

/// The answer of `region` for an engineer.
[[nodiscard]] std::string region_text(const DeviceRegion& device);

}  // namespace zwidth::report
