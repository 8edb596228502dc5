#pragma once

#include <string>

#include "report/simulated_loop.hpp"

namespace zwidth::report {

/// What `simulate` prints: set-up, verdict, numbers with units, the linear answer.
[[nodiscard]] std::string simulation_text(const SimulatedLoop& loop);

}  // namespace zwidth::report
