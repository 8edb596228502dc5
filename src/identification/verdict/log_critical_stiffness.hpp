#pragma once

#include <optional>

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

/// log K_CR, as a fit sees the limit: without the wall's damper; nothing where that is no device, or has no limit.
[[nodiscard]] std::optional<double> log_critical_stiffness(DeviceParameters device);

}  // namespace zwidth::internal
