#pragma once

#include <string>

#include "zwidth/design/notch_design.hpp"

namespace zwidth::report {

/// The answer for people: what to paste, what it gains over the drift, what it costs.
[[nodiscard]] std::string notch_text(const Device& device, const NotchOptions& options, const NotchDesign& notch);

}  // namespace zwidth::report
