#pragma once

#include "report/designed_device.hpp"
#include "results/json.hpp"

namespace zwidth::report {

/// The answer of `design --json`, schema zwidth.design/1 (docs/design.md).
[[nodiscard]] results::Json design_json(const DesignedDevice& designed);

}  // namespace zwidth::report
