#pragma once

#include "zwidth/signal/recording.hpp"

namespace zwidth::internal {

/// Whether the signal stands at an extreme value again and again, as no motion of a linear device does.
[[nodiscard]] bool is_clipped(const Channel& channel, double sampling_period, SignalRole role);

}  // namespace zwidth::internal
