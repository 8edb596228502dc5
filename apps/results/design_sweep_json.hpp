#pragma once

#include <nlohmann/json.hpp>

#include "report/design_sweep.hpp"

namespace zwidth::report {

/// The answer of `design --sweep --json`, schema zwidth.design_sweep/1 (docs/design.md).
[[nodiscard]] nlohmann::ordered_json sweep_json(const DesignSweep& sweep);

}  // namespace zwidth::report
