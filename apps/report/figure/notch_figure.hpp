#pragma once

#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/design/notch_design.hpp"

namespace zwidth::report {

/// The stiffest wall over the modal shift, with and without; and the gain of the notch. Throws OutputFailed.
[[nodiscard]] std::string draw_notch(const Device& device, const NotchOptions& options, const NotchDesign& notch,
                                     FigureFormat format);

}  // namespace zwidth::report
