#pragma once

#include <optional>
#include <utility>

#include "zwidth/design/region.hpp"
#include "zwidth/design/wall_summary.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::report {

/// A device with its answer, the input of every report (text, JSON, HTML).
struct AnalysedDevice {
  Device device;
  Analysis analysis;
  std::optional<WallSummary> walls = {};  ///< where they were asked for
  std::optional<WallRegion> region = {};  ///< of a page, seen through the filters of the wall to run
};

/// Throws as analyze() does.
[[nodiscard]] inline AnalysedDevice analysed_device(Device device, const AnalysisOptions& options = {}) {
  Analysis analysis = analyze(device, options);
  return {std::move(device), std::move(analysis), std::nullopt};
}

/// The device with another wall.
[[nodiscard]] inline Device device_with_wall(const Device& device, const Wall& wall) {
  DeviceParameters parameters = device.parameters();
  parameters.wall = wall;
  return Device(std::move(parameters));
}

/// Whose limit stands as the critical stiffness, and whose margins as those of the wall.
[[nodiscard]] inline Holder holder_of(const HoldingLimits& limits) {
  return limits.user ? Holder::user : Holder::nobody;
}

/// What stands beside the answer where it is asked for.
struct Detail {
  bool decibels = false;  ///< stiffnesses in dB re 1 N/m or 1 N m/rad, too
  bool formulas = false;  ///< formulas of the literature, where they say nothing of this device, too
};

}  // namespace zwidth::report
