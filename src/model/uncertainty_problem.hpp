#pragma once

#include <optional>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// The first impossible thing about the uncertainty of parameters that are otherwise a device's; it must be present.
[[nodiscard]] std::optional<DeviceProblem> find_uncertainty_problem(const DeviceParameters& parameters);

}  // namespace zwidth::internal
