#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "rig/driver.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth::rig {

/// Of a simulated device.
struct SimulatedDriverOptions {
  double start = 0.0;      ///< m or rad
  bool real_time = false;  ///< it keeps the clock
};

/// What may stand for a driver.
inline constexpr std::string_view driver_names =
    "simulated, odrive:PORT, simplefoc:PORT, moteus:PORT, vesc:PORT, serial:PORT, udp:HOST:PORT, odrive-can:ADAPTER, "
    "moteus-can:ADAPTER, vesc-can:ADAPTER";

/// What is wrong with a name for a driver, as far as the name alone tells.
[[nodiscard]] std::optional<DriveProblem> find_driver_name_problem(std::string_view name);

/// Why no damper can run on the drive of that driver, as far as the name tells.
[[nodiscard]] std::optional<OptionProblem> find_damper_problem(std::string_view name);

/// The driver of that name. Throws DriverFailed for another, and where it is not reached; Error (invalid_argument) where
/// the device does not tell what its drive needs to be told.
[[nodiscard]] std::unique_ptr<Driver> open_driver(const std::string& name, const Device& device,
                                                  const SimulatedDriverOptions& simulated);

}  // namespace zwidth::rig
