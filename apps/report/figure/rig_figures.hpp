#pragma once

#include <string>

#include "report/figure/canvas.hpp"
#include "zwidth/rig/results.hpp"

namespace zwidth::report {

// The picture of what an action on a rig found. Each throws OutputFailed as gnuplot does, and where the rig stopped before
// anything was measured that it draws.

/// The response with its 95 % bands.
[[nodiscard]] std::string draw_rig(const Device& device, const RigMeasurement& measurement, FigureFormat format);
/// Data, fit and residual.
[[nodiscard]] std::string draw_rig(const Device& device, const RigIdentification& identified, FigureFormat format);
/// The end of the first trial that oscillates.
[[nodiscard]] std::string draw_rig(const Device& device, const RigRelay& found, FigureFormat format);
/// Force that was sent and position as sensed, from the first cycle.
[[nodiscard]] std::string draw_rig(const Device& device, const RigWall& wall, FigureFormat format);
/// The growth after each impulse over the stiffness.
[[nodiscard]] std::string draw_rig(const Device& device, const RigLimit& limit, FigureFormat format);

/// Whether there is something to draw.
[[nodiscard]] bool has_figure(const RigWall& wall);
[[nodiscard]] bool has_figure(const RigLimit& limit);

}  // namespace zwidth::report
