#include "rig/open_driver.hpp"

#include <string_view>

#include "rig/simulated_driver.hpp"
#include "rig/udp_driver.hpp"

namespace zwidth::rig {

std::unique_ptr<Driver> open_driver(const std::string& name, const Device& device,
                                    const SimulatedDriverOptions& simulated) {
  if (name == "simulated") return std::make_unique<SimulatedDriver>(device, simulated.start, simulated.real_time);
  constexpr std::string_view udp = "udp:";
  if (name.starts_with(udp)) {
    return std::make_unique<UdpDriver>(name.substr(udp.size()), device.loop().sampling_period);
  }
  throw DriverFailed("is no driver; simulated, or udp:HOST:PORT");
}

}  // namespace zwidth::rig
