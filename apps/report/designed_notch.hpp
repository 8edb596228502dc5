#pragma once

#include <optional>
#include <string>

#include "report/analysed_device.hpp"
#include "report/figure/canvas.hpp"
#include "zwidth/design/notch_design.hpp"

namespace zwidth::report {

/// A notch with what it changes on the device as it is, the input of every report of a notch.
struct DesignedNotch {
  NotchOptions options;
  NotchDesign design;
  AnalysedDevice without;              ///< with the designed wall in [wall]
  std::optional<AnalysedDevice> with;  ///< the same and the notch; absent where there is none
};

/// Designs the notch and analyses the device without and with it, at the designed stiffness. Throws what
/// design_notch() throws.
[[nodiscard]] DesignedNotch designed_notch(const Device& device, const NotchOptions& options);

/// The answer for people: what to paste, what it gains over the drift, what it costs.
[[nodiscard]] std::string notch_text(const DesignedNotch& notch);

/// The stiffest wall over the drift, with and without; and the gain of the notch. Throws OutputFailed.
[[nodiscard]] std::string draw_notch(const DesignedNotch& notch, FigureFormat format);

}  // namespace zwidth::report
