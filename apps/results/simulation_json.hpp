#pragma once

#include "report/simulated_loop.hpp"
#include "results/json.hpp"

namespace zwidth::report {

/// The document of `simulate --json`, schema zwidth.simulation/1, keys in their documented order. What does not exist
/// is null; NaN and infinities never appear.
[[nodiscard]] results::Json simulation_json(const SimulatedLoop& loop);

}  // namespace zwidth::report
