#pragma once

#include <utility>

#include "zwidth/model/device.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::report {

/// A device with its answer, the input of every report (text, JSON, HTML).
struct AnalysedDevice {
  Device device;
  Analysis analysis;
};

/// Analyses the device; throws as analyze() does.
[[nodiscard]] inline AnalysedDevice analysed_device(Device device) {
  Analysis analysis = analyze(device);
  return {std::move(device), std::move(analysis)};
}

}  // namespace zwidth::report
