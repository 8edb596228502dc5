#pragma once

#include <string>

#include "report/relay_report.hpp"

namespace zwidth::report {

/// The answer for a reader: every trial, their mean, the predictions, and what it all means for a wall.
[[nodiscard]] std::string relay_text(const RelayReport& report);

}  // namespace zwidth::report
