#pragma once

#include <optional>
#include <string>

#include "zwidth/model/device.hpp"

namespace zwidth::report {

/// "notch 60 Hz, depth 0.1".
[[nodiscard]] std::string filter_text(const WallFilter& filter);

/// "notch 60 Hz, depth 0.1; low-pass 300 Hz", in the order in which they run. Nothing without filters.
[[nodiscard]] std::optional<std::string> wall_filters_text(const Wall& wall);

/// "8 N s/m at 10 kHz, delay 100 us" of a damper in a loop of its own; nothing without one, or one of B = 0.
[[nodiscard]] std::optional<std::string> damper_apart_text(const Device& device, double damping);

}  // namespace zwidth::report
