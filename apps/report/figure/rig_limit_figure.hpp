#pragma once

#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/rig/results.hpp"

namespace zwidth::report {

/// How fast the oscillation after each impulse grew (above 0) or decayed, over the stiffness of the wall, with three of its
/// deviations; K_CR as measured and as predicted. Trials of which nothing was read are left out. Throws OutputFailed.
[[nodiscard]] std::string draw_limit_trials(const Device& device, const RigLimit& limit, FigureFormat format);

}  // namespace zwidth::report
