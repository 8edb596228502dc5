#pragma once

#include <string>
#include <vector>

#include "results/json.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"

namespace zwidth::report {

/// The estimates in the order of the reports.
[[nodiscard]] std::vector<ParameterEstimate> estimates_of(const RigidBodyFit& fit);

/// The parameters with their intervals, how they were found, and every remark.
[[nodiscard]] std::string rigid_body_text(const RigidBodyIdentification& identified);

/// Schema zwidth.inverse_dynamics/1: see docs/inverse_dynamics.md.
[[nodiscard]] results::Json rigid_body_json(const RigidBodyIdentification& identified);

}  // namespace zwidth::report
