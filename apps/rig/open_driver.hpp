#pragma once

#include <memory>
#include <string>

#include "rig/driver.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::rig {

/// Of a simulated device.
struct SimulatedDriverOptions {
  double start = 0.0;      ///< m or rad
  bool real_time = false;  ///< it keeps the clock
};

/// The driver of that name: "simulated", "udp:HOST:PORT". Throws DriverFailed for another, and where it is not reached.
[[nodiscard]] std::unique_ptr<Driver> open_driver(const std::string& name, const Device& device,
                                                  const SimulatedDriverOptions& simulated);

}  // namespace zwidth::rig
