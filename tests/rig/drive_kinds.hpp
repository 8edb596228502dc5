#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "rig/odrive_driver.hpp"
#include "rig/odrive_firmware.hpp"

namespace zwidth::test {

/// A kind of drive on a serial line, by the name of its driver.
struct DriveKind {
  std::string_view name;
  std::unique_ptr<Firmware> (*firmware)();
  std::unique_ptr<rig::Driver> (*driver)(const rig::SerialLink& link);
  bool has_watchdog;
  bool has_checksums;
  bool has_nan;
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
    DriveKind{"odrive", new_firmware<OdriveFirmware>, new_driver<rig::OdriveDriver>, true, true, true}};

}  // namespace zwidth::test
