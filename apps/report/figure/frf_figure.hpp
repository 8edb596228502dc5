#pragma once

#include <string>

#include "report/figure/canvas.hpp"
#include "results/frf_json.hpp"

namespace zwidth::report {

/// Magnitude and phase with their 95 % bands, and coherence, over frequency, with every crossover marked and listed.
/// Throws OutputFailed as gnuplot does.
[[nodiscard]] std::string draw_frf(const MeasuredResponse& frf, const results::FrfUnits& units, FigureFormat format);

}  // namespace zwidth::report
