#pragma once

#include <numbers>
#include <optional>
#include <string>

namespace zwidth {

/// The motor drive that stands between the device and a program: what its turns, currents and volts are of the device.
struct MotorDrive {
  std::optional<double> travel;           ///< of the device per turn behind the gear, m or rad; > 0; absent: 2 pi rad
  double gear = 1.0;                      ///< turns of the motor per turn behind the gear; > 0
  double sign = 1.0;                      ///< 1; -1 where the drive counts against the device
  double force_sign = 1.0;                ///< 1; -1 where its torque pushes against the way that it counts
  std::optional<double> torque_constant;  ///< of the motor, N m/A; > 0
  std::optional<double> torque_per_volt;  ///< of the motor at rest, N m/V; > 0
  std::optional<int> id;  ///< ODrive: axis, 0 or 1, on CAN its node; moteus: 1 to 127; VESC on CAN; absent: the default
  std::string command = "M";  ///< SimpleFOC: the letter that the sketch gave the motor
  std::optional<int> baud;    ///< of the serial line or the CAN bus, 1200 to 4000000; absent: the firmware's default

  /// m or rad of the device per turn of the motor: sign travel/gear.
  [[nodiscard]] double position_per_turn() const { return sign * travel.value_or(2.0 * std::numbers::pi) / gear; }
  /// N m, torque of the motor that pushes the device with a unit of force: force_sign position_per_turn()/(2 pi), an ideal
  /// gear.
  [[nodiscard]] double torque_per_force() const { return force_sign * position_per_turn() / (2.0 * std::numbers::pi); }
};

}  // namespace zwidth
