#pragma once

#include <string>

#include "report/analysed_device.hpp"
#include "zwidth/design/region.hpp"

namespace zwidth::report {

/// The answer of `region` for an engineer.
[[nodiscard]] std::string region_text(const Device& device, const WallRegion& walls, const Detail& detail = {});

}  // namespace zwidth::report
