#pragma once

#include "zwidth/model/device.hpp"

namespace zwidth::test {

/// A carriage on a belt, at a rate that every drive's line carries at its default speed: 25 mm in a turn behind a gear of
/// 2, counted backwards.
inline Device belt_device(double sampling_period = 0.01) {
  DeviceParameters parameters;
  parameters.name = "belt";
  parameters.bodies.push_back({"carriage", 2.0, 8.0, 0.0, 0.0});
  parameters.loop.sampling_period = sampling_period;
  parameters.wall.stiffness = 20.0;
  parameters.actuator.force_limit = 20.0;
  MotorDrive& drive = parameters.driver.emplace();
  drive.travel = 0.025;
  drive.gear = 2.0;
  drive.sign = -1.0;
  drive.torque_constant = 0.05;
  drive.torque_per_volt = 0.02;
  return Device(parameters);
}

}  // namespace zwidth::test
