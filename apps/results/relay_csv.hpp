#pragma once

#include <string>

#include "report/relay_report.hpp"

namespace zwidth::report {

/// "time_s,force_1,position_1,force_2,...": the records of all trials side by side, 17 significant digits.
[[nodiscard]] std::string relay_csv(const RelayReport& report);

}  // namespace zwidth::report
