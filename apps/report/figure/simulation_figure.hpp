#pragma once

#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/simulation/simulate.hpp"

namespace zwidth::report {

/// Positions (sensed and held body, the wall shaded) over forces (commanded, user's) against time, with the verdict.
/// Requires a kept trajectory. Throws OutputFailed as gnuplot does.
[[nodiscard]] std::string draw_simulation_figure(const Device& device, const Simulation& result, FigureFormat format);

}  // namespace zwidth::report
