#pragma once

#include "results/json.hpp"
#include "zwidth/design/design_target.hpp"

namespace zwidth::results {

/// The answer of `design --target --json`, schema zwidth.design_target/1 (docs/design.md).
[[nodiscard]] Json design_target_json(const Device& device, const DesignTargetOptions& options,
                                      const DesignTargets& targets);

}  // namespace zwidth::results
