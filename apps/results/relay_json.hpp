#pragma once

#include "report/relay_report.hpp"
#include "results/json.hpp"

namespace zwidth::report {

/// Schema "zwidth.relay/1": trials, their mean, predictions, remarks. Numbers that do not exist are null.
[[nodiscard]] results::Json relay_json(const RelayReport& report);

}  // namespace zwidth::report
