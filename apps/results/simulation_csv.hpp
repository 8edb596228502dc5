#pragma once

#include <string>

#include "zwidth/simulation/simulate.hpp"

namespace zwidth::results {

/// The kept points of the run as comma-separated values with a header: time_s, measured, command, user_force, then
/// position and velocity of every body ("handle.position"), of a transfer function its output. SI units and radians.
[[nodiscard]] std::string simulation_csv(const Device& device, const Simulation& result);

}  // namespace zwidth::results
