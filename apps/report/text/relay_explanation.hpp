#pragma once

#include <string>
#include <vector>

#include "report/relay_report.hpp"

namespace zwidth::report {

/// What the experiment says about the wall's limit, one sentence or two each: whether it agrees with linear theory,
/// what friction does to it, and which other oscillations exist. Empty where no trial oscillates or without a device.
[[nodiscard]] std::vector<std::string> relay_explanation(const RelayReport& report);

}  // namespace zwidth::report
