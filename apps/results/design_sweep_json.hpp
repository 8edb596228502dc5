#pragma once

#include "report/design_sweep.hpp"
#include "results/json.hpp"

namespace zwidth::report {

/// The answer of `design --sweep --json`, schema zwidth.design_sweep/1 (docs/design.md).
[[nodiscard]] results::Json sweep_json(const DesignSweep& sweep);

}  // namespace zwidth::report
