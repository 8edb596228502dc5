#pragma once

#include <nlohmann/json.hpp>

#include "report/designed_device.hpp"

namespace zwidth::report {

/// The answer of `design --json`, schema zwidth.design/1 (docs/design.md).
[[nodiscard]] nlohmann::ordered_json design_json(const DesignedDevice& designed);

}  // namespace zwidth::report
