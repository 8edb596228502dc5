#pragma once

#include <span>
#include <vector>

#include "zwidth/simulation/simulate.hpp"

namespace zwidth::internal {

/// Sets the judged run beside its linear answer: its nonlinear parts, whether the two agree, and whether a growth that
/// linear analysis sees is hidden, which makes the verdict undecided; and whether the encoder chatters. `sensed`: the
/// sensed positions of the whole run.
void compare_with_linear(Simulation& result, const Device& device, std::span<const double> sensed);

/// What the verdict does not say.
[[nodiscard]] std::vector<Remark> simulation_remarks(const Simulation& result, const Device& device,
                                                     const SimulationOptions& options, std::span<const double> sensed);

}  // namespace zwidth::internal
