#include "rig/open_driver.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "rig/can_bus.hpp"
#include "rig/microcontroller_driver.hpp"
#include "rig/moteus_driver.hpp"
#include "rig/odrive_can_driver.hpp"
#include "rig/odrive_driver.hpp"
#include "rig/simplefoc_driver.hpp"
#include "rig/simulated_driver.hpp"
#include "rig/udp_driver.hpp"
#include "rig/vesc_driver.hpp"
#include "zwidth/error.hpp"

namespace zwidth::rig {
namespace {

template <typename SerialKind, bool is_can = false>
std::unique_ptr<Driver> open_serial(const std::string& port, const Device& device) {
  if (!device.parameters().driver) {
    throw Error(
        ErrorCode::invalid_argument,
        "driver: is missing: what the motor's turns and torque are of the device; add [driver], empty where the "
        "motor turns with the device");
  }
  return std::make_unique<SerialKind>(SerialLink{.port = port,
                                                 .drive = *device.parameters().driver,
                                                 .sampling_period = device.loop().sampling_period,
                                                 .is_can = is_can});
}

std::unique_ptr<Driver> open_microcontroller(const std::string& port, const Device& device) {
  return std::make_unique<MicrocontrollerDriver>(SerialLink{.port = port,
                                                            .drive = device.parameters().driver.value_or(MotorDrive{}),
                                                            .sampling_period = device.loop().sampling_period});
}

std::unique_ptr<Driver> open_udp(const std::string& address, const Device& device) {
  return std::make_unique<UdpDriver>(address, device.loop().sampling_period);
}

std::optional<DriveProblem> find_port_problem(std::string_view port) {
  if (!port.empty()) return std::nullopt;
  return DriveProblem{DriveProblemCode::no_port_named};
}

std::optional<DriveProblem> find_adapter_problem(std::string_view name) {
  if (can_adapter(name)) return std::nullopt;
  return DriveProblem{DriveProblemCode::no_adapter_named};
}

std::optional<DriveProblem> find_udp_problem(std::string_view address) {
  const auto found = udp_address(address);
  return found ? std::nullopt : std::optional(found.error());
}

struct Kind {
  std::string_view prefix;
  std::optional<DriveProblem> (*find_problem)(std::string_view where);
  std::unique_ptr<Driver> (*open)(const std::string& where, const Device& device);
  bool closes_damper = false;
};

constexpr std::array kinds{Kind{"odrive:", find_port_problem, open_serial<OdriveDriver>, true},
                           Kind{"simplefoc:", find_port_problem, open_serial<SimplefocDriver>, true},
                           Kind{"moteus:", find_port_problem, open_serial<MoteusDriver>, true},
                           Kind{"vesc:", find_port_problem, open_serial<VescDriver>},
                           Kind{"odrive-can:", find_adapter_problem, open_serial<OdriveCanDriver, true>},
                           Kind{"moteus-can:", find_adapter_problem, open_serial<MoteusDriver, true>, true},
                           Kind{"vesc-can:", find_adapter_problem, open_serial<VescDriver, true>},
                           Kind{"serial:", find_port_problem, open_microcontroller},
                           Kind{"udp:", find_udp_problem, open_udp}};

const Kind* kind_of(std::string_view name) {
  const auto* const found =
      std::ranges::find_if(kinds, [&](const Kind& kind) { return name.starts_with(kind.prefix); });
  return found == kinds.end() ? nullptr : found;
}

DriveProblem unknown_driver() {
  return {DriveProblemCode::unknown_driver, {}, {{"drivers", std::string(driver_names)}}};
}

}  // namespace

std::optional<DriveProblem> find_driver_name_problem(std::string_view name) {
  if (name == "simulated") return std::nullopt;
  const Kind* kind = kind_of(name);
  if (kind == nullptr) return unknown_driver();
  return kind->find_problem(name.substr(kind->prefix.size()));
}

std::optional<OptionProblem> find_damper_problem(std::string_view name) {
  const Kind* kind = kind_of(name);
  if (kind == nullptr || kind->closes_damper) return std::nullopt;
  return no_damper_problem(name);
}

std::unique_ptr<Driver> open_driver(const std::string& name, const Device& device,
                                    const SimulatedDriverOptions& simulated) {
  if (name == "simulated") return std::make_unique<SimulatedDriver>(device, simulated.start, simulated.real_time);
  if (const Kind* kind = kind_of(name)) return kind->open(name.substr(kind->prefix.size()), device);
  throw DriverFailed(unknown_driver());
}

}  // namespace zwidth::rig
