#pragma once

#include <vector>

#include "rig/can_port.hpp"
#include "rig/serial_driver.hpp"

namespace zwidth::rig {

/// What a cycle of a drive sends and awaits on a CAN bus, and how fast that is.
struct CanCycle {
  std::vector<CanFrameShape> asked;  ///< question and answer
  std::vector<CanFrameShape> force;
  CanBitRates rates;
};

/// The bus's rates: `nominal`, unless driver.baud says otherwise, and that of data.
[[nodiscard]] CanBitRates can_rates(const SerialLink& link, double nominal, double data = 0.0);

/// With what a cycle takes on the bus and on the adapter's line. Throws DriverFailed where these, or the firmware's
/// watchdog, do not carry the loop.
[[nodiscard]] DriverFacts on_can_bus(DriverFacts facts, const SerialLink& link, const CanCycle& cycle);

/// The bus behind the adapter that the link names. Throws DriverFailed.
[[nodiscard]] std::unique_ptr<CanBus> bus_of(const SerialLink& link, const CanBitRates& rates);

}  // namespace zwidth::rig
