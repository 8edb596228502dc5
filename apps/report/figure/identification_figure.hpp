#pragma once

#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/identification/identification.hpp"
#include "zwidth/identification/rigid_body_identification.hpp"

namespace zwidth::report {

/// What the figure says of its data.
struct IdentificationLabels {
  std::string title;
  std::string points = "measured, with its 95 % band";
};

/// The measured response with its 95 % band and the fitted one: magnitude in dB over phase in degrees, frequency in Hz
/// (as Figs. 4 and 8 of Díaz & Gil); below, what the fit leaves, in standard deviations of the noise. Throws OutputFailed
/// as gnuplot does, and where there is no response.
[[nodiscard]] std::string draw_identification(const Identification& identified, FigureFormat format);

/// The same with a title and a name of the points of one's own.
[[nodiscard]] std::string draw_identification(const Identification& identified, const IdentificationLabels& labels,
                                              FigureFormat format);

/// A zoom of the measured force and the fitted body's, and what the fit leaves of the whole.
[[nodiscard]] std::string draw_identification(const RigidBodyIdentification& identified, FigureFormat format);

}  // namespace zwidth::report
