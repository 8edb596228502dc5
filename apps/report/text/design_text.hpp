#pragma once

#include <string>

#include "report/designed_device.hpp"

namespace zwidth::report {

/// What limits the device and what every one of its numbers does to it: at most 100 columns, the strongest first.
[[nodiscard]] std::string design_text(const DesignedDevice& designed);

}  // namespace zwidth::report
