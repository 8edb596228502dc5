#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "rig/microcontroller_driver.hpp"
#include "rig/microcontroller_firmware.hpp"
#include "rig/moteus_driver.hpp"
#include "rig/moteus_firmware.hpp"
#include "rig/odrive_driver.hpp"
#include "rig/odrive_firmware.hpp"
#include "rig/simplefoc_driver.hpp"
#include "rig/simplefoc_firmware.hpp"
#include "rig/vesc_driver.hpp"
#include "rig/vesc_firmware.hpp"

namespace zwidth::test {

/// A kind of drive on a serial line, by the name of its driver.
struct DriveKind {
  std::string_view name;
  std::unique_ptr<Firmware> (*firmware)();
  std::unique_ptr<rig::Driver> (*driver)(const rig::SerialLink& link);
  bool has_watchdog;
  bool has_checksums;
  bool has_nan;
  bool closes_damper;
};

template <typename Kind>
std::unique_ptr<Firmware> new_firmware() {
  return std::make_unique<Kind>();
}
template <typename Kind>
std::unique_ptr<rig::Driver> new_driver(const rig::SerialLink& link) {
  return std::make_unique<Kind>(link);
}

inline constexpr std::array drive_kinds{
    DriveKind{"odrive", new_firmware<OdriveFirmware>, new_driver<rig::OdriveDriver>, true, true, true, true},
    DriveKind{"moteus", new_firmware<MoteusFirmware>, new_driver<rig::MoteusDriver>, true, true, true, true},
    DriveKind{"vesc", new_firmware<VescFirmware>, new_driver<rig::VescDriver>, true, true, false, false},
    DriveKind{"simplefoc", new_firmware<SimplefocFirmware>, new_driver<rig::SimplefocDriver>, false, false, true, true},
    DriveKind{"serial", new_firmware<MicrocontrollerFirmware>, new_driver<rig::MicrocontrollerDriver>, true, true, true,
              false}};

}  // namespace zwidth::test
