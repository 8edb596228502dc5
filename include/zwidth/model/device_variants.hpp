#pragma once

#include <string>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth {

/// A value of a key, as it was written, and the device that it makes.
struct DeviceVariant {
  std::string value;  ///< as it was given
  Device device;      ///< with that value
};

/// One device with several values of one key.
struct DeviceVariants {
  std::string key;                      ///< of the device file: "loop.sensed"
  std::vector<DeviceVariant> variants;  ///< in the order given
};

}  // namespace zwidth
