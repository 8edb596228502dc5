#pragma once

#include <utility>
#include <vector>

#include "zwidth/model/device.hpp"

namespace zwidth::test {

// Table I of Díaz & Gil: body 0 is the motor, body 1 the handle.
inline DeviceParameters lhifam_parameters() {
  DeviceParameters device;
  device.name = "LHIfAM";
  device.bodies = {{"motor", 0.3, 0.1, 0.0, 0.0}, {"handle", 5.1, 3.4, 0.0, 0.0}};
  device.links = {{0, 1, 79.5e3, 15.0}};
  device.loop = {0, 0, 1, 1e-3, 0.0};
  return device;
}

// Its cable at reduced pretension, as inferred from Figs. 8-9 (never printed).
inline DeviceParameters reduced_pretension_parameters() {
  DeviceParameters device = lhifam_parameters();
  device.links[0] = {0, 1, 27.55e3, 10.5};
  return device;
}

// Table I with a rigid cable.
inline DeviceParameters rigid_parameters() {
  DeviceParameters device;
  device.name = "rigid";
  device.bodies = {{"body", 5.4, 3.5, 0.0, 0.0}};
  device.loop = {0, 0, 0, 1e-3, 0.0};
  return device;
}

inline DeviceParameters transfer_function_parameters(std::vector<double> numerator, std::vector<double> denominator,
                                                     double period, double delay = 0.0) {
  DeviceParameters device;
  device.name = "transfer function";
  device.transfer_function = TransferFunction{std::move(numerator), std::move(denominator)};
  device.loop.sampling_period = period;
  device.loop.delay = delay;
  return device;
}

inline DeviceParameters handle_sensed(DeviceParameters device) {
  device.loop.sensed = 1;
  return device;
}

inline DeviceParameters with_delay(DeviceParameters device, double delay) {
  device.loop.delay = delay;
  return device;
}

}  // namespace zwidth::test
