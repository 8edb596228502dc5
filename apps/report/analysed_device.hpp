#pragma once

#include <optional>
#include <utility>

#include "zwidth/design/wall_summary.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::report {

/// A device with its answer, the input of every report (text, JSON, HTML).
struct AnalysedDevice {
  Device device;
  Analysis analysis;
  std::optional<WallSummary> walls = {};  ///< where they were asked for
};

/// Throws as analyze() does.
[[nodiscard]] inline AnalysedDevice analysed_device(Device device, const AnalysisOptions& options = {}) {
  Analysis analysis = analyze(device, options);
  return {std::move(device), std::move(analysis), std::nullopt};
}

}  // namespace zwidth::report
