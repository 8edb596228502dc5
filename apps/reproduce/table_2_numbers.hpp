#pragma once

#include <vector>

#include "reproduce/reproduction.hpp"

namespace zwidth::report {

/// Table II: every row beside ours, the fit, and what agrees and what does not.
[[nodiscard]] std::vector<PaperNumber> table_2_numbers();

}  // namespace zwidth::report
