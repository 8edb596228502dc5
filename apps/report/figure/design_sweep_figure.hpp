#pragma once

#include <string>

#include "report/design_sweep.hpp"
#include "report/figure/canvas.hpp"

namespace zwidth::report {

/// One parameter: K_CR over it, bold, with every branch of crossovers by the mechanism that it belongs to (points must
/// hold their crossovers) and the any-user limit dashed. Two: K_CR as a map of colours. Throws OutputFailed.
[[nodiscard]] std::string draw_sweep(const DesignSweep& sweep, FigureFormat format);

}  // namespace zwidth::report
