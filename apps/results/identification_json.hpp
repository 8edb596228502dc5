#pragma once

#include <string>

#include "results/json.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"

namespace zwidth::results {

/// {"virtual_damping", "velocity_filter_hz", "filters"}: what a critical stiffness is given with.
void to_json(Json& json, const StiffnessBasis& basis);

/// The document of `identify --json`, schema zwidth.identification/1 (docs/identification.md).
[[nodiscard]] Json identification_json(const Identification& identified, PointsInJson points = PointsInJson::left_out);

/// That of inverse dynamics, schema zwidth.inverse_dynamics/1 (docs/inverse_dynamics.md).
[[nodiscard]] Json identification_json(const RigidBodyIdentification& identified);

// What `identify --csv` writes, the numbers of its figure: measured and fitted.

/// The response, line by line.
[[nodiscard]] std::string identification_csv(const Identification& identified);
/// The force behind the low-pass over time.
[[nodiscard]] std::string identification_csv(const RigidBodyIdentification& identified);

}  // namespace zwidth::results
