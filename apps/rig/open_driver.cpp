#include "rig/open_driver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "rig/moteus_driver.hpp"
#include "rig/odrive_driver.hpp"
#include "rig/simplefoc_driver.hpp"
#include "rig/simulated_driver.hpp"
#include "rig/udp_driver.hpp"
#include "rig/vesc_driver.hpp"
#include "zwidth/error.hpp"

namespace zwidth::rig {
namespace {

template <typename SerialKind>
std::unique_ptr<Driver> open_serial(const std::string& port, const Device& device) {
  if (!device.parameters().driver) {
    throw Error(
        ErrorCode::invalid_argument,
        "driver: is missing: what the motor's turns and torque are of the device; add [driver], empty where the "
        "motor turns with the device");
  }
  return std::make_unique<SerialKind>(
      SerialLink{.port = port, .drive = *device.parameters().driver, .sampling_period = device.loop().sampling_period});
}

std::unique_ptr<Driver> open_udp(const std::string& address, const Device& device) {
  return std::make_unique<UdpDriver>(address, device.loop().sampling_period);
}

struct Kind {
  std::string_view prefix;
  std::unique_ptr<Driver> (*open)(const std::string& where, const Device& device);
};

constexpr std::array kinds{Kind{"odrive:", open_serial<OdriveDriver>}, Kind{"simplefoc:", open_serial<SimplefocDriver>},
                           Kind{"moteus:", open_serial<MoteusDriver>}, Kind{"vesc:", open_serial<VescDriver>},
                           Kind{"udp:", open_udp}};

const Kind* kind_of(std::string_view name) {
  const auto* const found =
      std::ranges::find_if(kinds, [&](const Kind& kind) { return name.starts_with(kind.prefix); });
  return found == kinds.end() ? nullptr : found;
}

}  // namespace

bool is_driver_name(std::string_view name) { return name == "simulated" || kind_of(name) != nullptr; }

std::unique_ptr<Driver> open_driver(const std::string& name, const Device& device,
                                    const SimulatedDriverOptions& simulated) {
  if (name == "simulated") return std::make_unique<SimulatedDriver>(device, simulated.start, simulated.real_time);
  if (const Kind* kind = kind_of(name)) return kind->open(name.substr(kind->prefix.size()), device);
  throw DriverFailed(fmt::format("is no driver; {}", driver_names));
}

}  // namespace zwidth::rig
