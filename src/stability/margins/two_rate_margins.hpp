#pragma once

#include "zwidth/model/device.hpp"
#include "zwidth/stability/wall_margins.hpp"

namespace zwidth::internal {

// wall_margins() of a device whose damper runs in a loop of its own (has_damper_loop()).
[[nodiscard]] WallMargins two_rate_margins(const Device& device);

}  // namespace zwidth::internal
