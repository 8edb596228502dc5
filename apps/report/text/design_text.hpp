#pragma once

#include <string>

#include "zwidth/design/design.hpp"

namespace zwidth::report {

/// What limits the device and what every one of its numbers does to it: at most 100 columns, the strongest first.
[[nodiscard]] std::string design_text(const Device& device, const Design& design);

}  // namespace zwidth::report
