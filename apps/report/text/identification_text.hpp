#pragma once

#include <span>
#include <string>

#include "report/identified_device.hpp"
#include "report/text/text_table.hpp"

namespace zwidth::report {

/// Value, unit, standard deviation and 95 % interval of each parameter.
[[nodiscard]] TextTable estimate_table(std::span<const ParameterEstimate> estimates, Motion motion);

/// The parameters with their intervals, what they make of the critical stiffness, and every remark.
[[nodiscard]] std::string identification_text(const IdentifiedDevice& identified);

}  // namespace zwidth::report
