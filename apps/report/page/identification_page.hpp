#pragma once

#include <string>

#include "report/document.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"

namespace zwidth::report {

// One self-contained page of a fit: its limits, numbers, what else explains the record, the figure, what was found. Throws
// OutputFailed as gnuplot does, Error as analyze_fit().
[[nodiscard]] std::string identification_page(const Identification& identified);
[[nodiscard]] std::string identification_page(const RigidBodyIdentification& identified);

/// The same within a page, without what was found.
void add_identification(Document& document, const Identification& identified);

}  // namespace zwidth::report
