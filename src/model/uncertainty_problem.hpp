#pragma once

#include <optional>
#include <string>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// The first impossible thing about the uncertainty of parameters that are otherwise a device's; it must be present.
[[nodiscard]] std::optional<DeviceProblem> find_uncertainty_problem(const DeviceParameters& parameters);

/// The same with the nearest covariance that is one: symmetric, and no combination of the parameters with a negative
/// variance, as rounding may leave where some are known far worse than others.
[[nodiscard]] Uncertainty without_rounding(Uncertainty uncertainty);

/// Why a device of assumed numbers is doubtful, with the remedy; there must be one at least.
[[nodiscard]] std::string assumed_reason(const std::vector<std::string>& keys);

}  // namespace zwidth::internal
