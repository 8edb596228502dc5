#pragma once

#include <optional>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// What is impossible about parameters.coordinates, which must be there: bodies, links or a transfer function beside them, a
// size, a number, a mass matrix.
[[nodiscard]] std::optional<DeviceProblem> find_coordinates_problem(const DeviceParameters& parameters);

}  // namespace zwidth::internal
