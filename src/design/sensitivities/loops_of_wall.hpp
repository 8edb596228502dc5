#pragma once

#include "zwidth/model/device.hpp"

namespace zwidth::internal {

// Whether both a spring and a damper of the wall act, each in a loop of its own. A stiffness that is not known counts as one.
[[nodiscard]] bool has_two_loops(const Device& device);

// The device as one loop, where its wall has one: a damper alone in its own, a spring alone in its.
[[nodiscard]] Device in_one_loop(const Device& device);

}  // namespace zwidth::internal
