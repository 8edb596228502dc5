#pragma once

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// Throws Error (invalid_argument) where the device's damper runs in a loop of its own: for computations of one rate, which
// would answer for another device.
void require_one_rate(const Device& device);

// How often the damper runs while the spring runs once: the whole number or whole part whose period is nearest.
[[nodiscard]] double rate_ratio(double loop_period, double damper_period);

}  // namespace zwidth::internal
