#pragma once

#include <span>
#include <string>

#include "report/analysed_device.hpp"

namespace zwidth::report {

/// The answer as one self-contained HTML page: what the text says, with figures, numbers and caveats.
/// Several devices: a comparison first. Throws OutputFailed when the figures cannot be drawn.
[[nodiscard]] std::string html_report(std::span<const AnalysedDevice> devices);

}  // namespace zwidth::report
