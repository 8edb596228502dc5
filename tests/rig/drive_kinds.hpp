#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "rig/can_adapter_firmware.hpp"
#include "rig/microcontroller_driver.hpp"
#include "rig/microcontroller_firmware.hpp"
#include "rig/moteus_driver.hpp"
#include "rig/moteus_firmware.hpp"
#include "rig/odrive_can_driver.hpp"
#include "rig/odrive_can_node.hpp"
#include "rig/odrive_driver.hpp"
#include "rig/odrive_firmware.hpp"
#include "rig/serial_can_nodes.hpp"
#include "rig/serial_device.hpp"
#include "rig/simplefoc_driver.hpp"
#include "rig/simplefoc_firmware.hpp"
#include "rig/vesc_driver.hpp"
#include "rig/vesc_firmware.hpp"

namespace zwidth::test {

/// A kind of drive on a serial line or a CAN bus, by the name of its driver.
struct DriveKind {
  std::string_view name;
  std::unique_ptr<Firmware> (*firmware)();
  std::unique_ptr<rig::Driver> (*driver)(const rig::SerialLink& link);
  bool has_watchdog;
  bool has_checksums;
  bool has_nan;
  bool closes_damper;
  std::optional<int> id = {};  ///< driver.id that it must be told by
};

template <typename Kind>
std::unique_ptr<Firmware> new_firmware() {
  return std::make_unique<Kind>();
}
template <typename Kind>
std::unique_ptr<rig::Driver> new_driver(const rig::SerialLink& link) {
  return std::make_unique<Kind>(link);
}
template <typename Node>
std::unique_ptr<Firmware> new_adapter() {
  return std::make_unique<CanAdapterFirmware>(std::make_unique<Node>());
}
template <typename Kind, int id>
std::unique_ptr<rig::Driver> new_can_driver(const rig::SerialLink& link) {
  rig::SerialLink on_bus = link;
  on_bus.is_can = true;
  on_bus.drive.id = id;
  return std::make_unique<Kind>(on_bus);
}

inline constexpr std::array drive_kinds{
    DriveKind{"odrive", new_firmware<OdriveFirmware>, new_driver<rig::OdriveDriver>, true, true, true, true},
    DriveKind{"moteus", new_firmware<MoteusFirmware>, new_driver<rig::MoteusDriver>, true, true, true, true},
    DriveKind{"vesc", new_firmware<VescFirmware>, new_driver<rig::VescDriver>, true, true, false, false},
    DriveKind{"simplefoc", new_firmware<SimplefocFirmware>, new_driver<rig::SimplefocDriver>, false, false, true, true},
    DriveKind{"serial", new_firmware<MicrocontrollerFirmware>, new_driver<rig::MicrocontrollerDriver>, true, true, true,
              false}};

// SLCAN has no checksum: USB and the bus have.
inline constexpr std::array can_drive_kinds{
    DriveKind{"odrive-can", new_adapter<OdriveCanNode>, new_can_driver<rig::OdriveCanDriver, 0>, true, false, true,
              false, 0},
    DriveKind{"moteus-can", new_adapter<MoteusCanNode>, new_can_driver<rig::MoteusDriver, 1>, true, false, true, true,
              1},
    DriveKind{"vesc-can", new_adapter<VescCanNode>, new_can_driver<rig::VescDriver, 23>, true, true, false, false, 23}};

/// For tests, whose names have no hyphen: odrive_can.
inline constexpr auto name_of_bus_drive = [](const auto& kind) {
  std::string name(kind.param.name);
  std::ranges::replace(name, '-', '_');
  return name;
};

/// That of a driver's name; null: there is none.
inline const DriveKind* drive_kind(std::string_view name) {
  const auto* const serial = std::ranges::find(drive_kinds, name, &DriveKind::name);
  if (serial != drive_kinds.end()) return serial;
  const auto* const on_bus = std::ranges::find(can_drive_kinds, name, &DriveKind::name);
  return on_bus == can_drive_kinds.end() ? nullptr : on_bus;
}

/// The belt with the id that the drive has on its bus.
inline Device belt_device_of(const DriveKind& kind, double sampling_period = 0.01) {
  DeviceParameters parameters = belt_device(sampling_period).parameters();
  parameters.driver->id = kind.id;
  return Device(parameters);
}

}  // namespace zwidth::test
