#pragma once

#include <string>

#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"
#include "zwidth/identification/time_domain.hpp"

namespace zwidth::report {

/// The parameters with their intervals, what they make of the critical stiffness or how they were found, and every remark.
[[nodiscard]] std::string identification_text(const Identification& identified);
[[nodiscard]] std::string identification_text(const TimeDomainIdentification& identified);
[[nodiscard]] std::string identification_text(const RigidBodyIdentification& identified);

}  // namespace zwidth::report
