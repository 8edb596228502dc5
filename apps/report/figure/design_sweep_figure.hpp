#pragma once

#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/design/parameter_sweep.hpp"

namespace zwidth::report {

/// One parameter: K_CR over it, bold, with every branch of crossovers by the mechanism that it belongs to (points must
/// hold their crossovers) and the absolute stability limit dashed. Two: K_CR as a map of colours. Throws OutputFailed.
[[nodiscard]] std::string draw_sweep(const Device& device, const ParameterSweep& sweep, FigureFormat format);

}  // namespace zwidth::report
