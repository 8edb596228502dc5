#pragma once

#include "zwidth/model/device.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::report {

/// A device with its answer, the input of every report (text, JSON, HTML).
struct AnalysedDevice {
  Device device;
  Analysis analysis;
};

}  // namespace zwidth::report
