#pragma once

#include <string>

#include "report/text/findings_text.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"
#include "zwidth/identification/time_domain.hpp"

namespace zwidth::report {

/// The parameters with their intervals, what they make of the critical stiffness or how they were found, and its findings.
[[nodiscard]] std::string identification_text(const Identification& identified,
                                              ShownFindings shown = ShownFindings::all);
[[nodiscard]] std::string identification_text(const TimeDomainIdentification& identified,
                                              ShownFindings shown = ShownFindings::all);
[[nodiscard]] std::string identification_text(const RigidBodyIdentification& identified,
                                              ShownFindings shown = ShownFindings::all);

}  // namespace zwidth::report
