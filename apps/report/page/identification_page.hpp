#pragma once

#include <string>

#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"

namespace zwidth::report {

// One self-contained page of a fit: its limits, numbers, what else explains the record, the figure, what was found. Throws
// OutputFailed as gnuplot does, Error as analyze() of the fitted device.
[[nodiscard]] std::string identification_page(const Identification& identified);
[[nodiscard]] std::string identification_page(const RigidBodyIdentification& identified);

}  // namespace zwidth::report
