#pragma once

#include <string>

#include "zwidth/design/design_comparison.hpp"

namespace zwidth::report {

/// A row per variant, and a sentence per user that says which is better.
[[nodiscard]] std::string comparison_text(const DesignComparison& comparison);

}  // namespace zwidth::report
