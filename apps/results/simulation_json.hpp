#pragma once

#include <nlohmann/json.hpp>

#include "report/simulated_loop.hpp"

namespace zwidth::report {

/// The document of `simulate --json`, schema zwidth.simulation/1, keys in their documented order. What does not exist
/// is null; NaN and infinities never appear.
[[nodiscard]] nlohmann::ordered_json simulation_json(const SimulatedLoop& loop);

}  // namespace zwidth::report
