#pragma once

#include "results/json.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::results {

/// The device file as JSON: the same keys, numbers in SI units.
[[nodiscard]] Json device_json(const DeviceParameters& parameters);

}  // namespace zwidth::results
