#pragma once

#include <string>

#include "report/analysed_device.hpp"
#include "report/figure/canvas.hpp"

namespace zwidth::report {

/// The axis of wall stiffness K: where the loop is stable, every crossover (numbered as in the Bode figure), and beside
/// them the rigid model's critical stiffness, Q and the wall, where there are such. Throws OutputFailed.
[[nodiscard]] std::string draw_stiffness_axis(const AnalysedDevice& analysed, FigureFormat format);

}  // namespace zwidth::report
