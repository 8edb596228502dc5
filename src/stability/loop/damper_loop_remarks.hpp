#pragma once

#include "zwidth/model/device.hpp"
#include "zwidth/remark.hpp"

namespace zwidth::internal {

/// What is known of one loop alone.
[[nodiscard]] Remark left_out_beside_damper_loop(const char* what);

/// Whose responses and models are those that the spring sees.
[[nodiscard]] Remark damper_closed_at_own_rate(const Device& device);

}  // namespace zwidth::internal
