#pragma once

#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/identification/excitation.hpp"

namespace zwidth::report {

/// Entitled by excitation_title(): the excitation over time (of many samples: its envelope) above its power density over frequency.
/// Throws OutputFailed as gnuplot does.
[[nodiscard]] std::string draw_excitation(const Excitation& excitation, FigureFormat format);

}  // namespace zwidth::report
