#include "rig/open_driver.hpp"

#include "rig/simulated_driver.hpp"

namespace zwidth::rig {

std::unique_ptr<Driver> open_driver(const std::string& name, const Device& device,
                                    const SimulatedDriverOptions& simulated) {
  if (name == "simulated") return std::make_unique<SimulatedDriver>(device, simulated.start, simulated.real_time);
  throw DriverFailed("is no driver; simulated");
}

}  // namespace zwidth::rig
