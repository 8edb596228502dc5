#pragma once

#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/identification/identification.hpp"

namespace zwidth::report {

/// What the figure says of its data.
struct IdentificationLabels {
  std::string title;
  std::string points = "measured, with its 95 % band";
};

/// The measured response with its 95 % band and the fitted one: magnitude in dB over phase in degrees, frequency in Hz
/// (as Figs. 4 and 8 of Díaz & Gil). Throws OutputFailed as gnuplot does.
[[nodiscard]] std::string draw_identification(const Identification& identified, FigureFormat format);

/// The same with a title and a name of the points of one's own.
[[nodiscard]] std::string draw_identification(const Identification& identified, const IdentificationLabels& labels,
                                              FigureFormat format);

}  // namespace zwidth::report
