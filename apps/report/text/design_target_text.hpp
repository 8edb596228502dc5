#pragma once

#include <string>

#include "zwidth/design/design_target.hpp"

namespace zwidth::report {

/// What each number alone would have to be, the cheapest first: at most 100 columns.
[[nodiscard]] std::string design_target_text(const Device& device, const DesignTargetOptions& options,
                                             const DesignTargets& targets);

}  // namespace zwidth::report
