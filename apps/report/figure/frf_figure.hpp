#pragma once

#include <string>

#include "report/figure/canvas.hpp"
#include "report/measured_frf.hpp"

namespace zwidth::report {

/// Magnitude and phase with their 95 % bands, and coherence, over frequency, with every crossover marked and listed.
/// Throws OutputFailed as gnuplot does.
[[nodiscard]] std::string draw(const MeasuredFrf& frf, FigureFormat format);

}  // namespace zwidth::report
