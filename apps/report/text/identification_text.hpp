#pragma once

#include <span>
#include <string>
#include <vector>

#include "report/text/findings_text.hpp"
#include "report/text/text_table.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"

namespace zwidth::report {

/// First verdict, critical stiffness and its interval; then the device's numbers, what else explains the records, what limits
/// the wall, and the findings.
[[nodiscard]] std::string identification_text(const Identification& identified,
                                              ShownFindings shown = ShownFindings::all);

/// The numbers of a rigid body with their intervals, how they were found, and the findings.
[[nodiscard]] std::string identification_text(const RigidBodyIdentification& identified,
                                              ShownFindings shown = ShownFindings::all);

/// "sound: critical stiffness 8.849 kN/m, 95 % from 8.7 kN/m to 9.01 kN/m (nobody holding, no damper)".
[[nodiscard]] std::string limit_line(const Identification& identified);

/// Pairs of numbers that are: all, or the first few.
[[nodiscard]] std::vector<std::string> hardly_told_apart(const ParameterFit& fit, ShownFindings shown);

/// Value, unit, standard deviation and 95 % interval of each parameter.
[[nodiscard]] TextTable estimate_table(std::span<const ParameterEstimate> estimates, Motion motion);

/// What else explains the records, and the critical stiffness over the range of each: all, or those that count.
[[nodiscard]] TextTable rival_table(const Identification& identified, ShownFindings shown);

/// What the fit leaves of each motion and of the response.
[[nodiscard]] std::string quality_of_fit(const Identification& identified);

}  // namespace zwidth::report
