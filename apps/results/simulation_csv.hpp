#pragma once

#include <string>

#include "report/simulated_loop.hpp"

namespace zwidth::report {

/// The kept points of the run as comma-separated values with a header: time_s, measured, command, user_force, then
/// position and velocity of every body ("handle.position"), of a transfer function its output. SI units and radians.
[[nodiscard]] std::string simulation_csv(const SimulatedLoop& loop);

}  // namespace zwidth::report
