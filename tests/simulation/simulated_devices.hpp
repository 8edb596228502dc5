#pragma once

#include "lhifam.hpp"
#include "zwidth/simulation/simulate.hpp"

namespace zwidth::test {

inline DeviceParameters three_body_parameters() {
  DeviceParameters device = lhifam_parameters();
  device.name = "three bodies";
  device.bodies.push_back({"tool", 0.4, 0.2, 0.0, 0.0});
  device.links.push_back({1, 2, 20e3, 4.0});
  device.loop.held = 2;
  return device;
}

inline DeviceParameters held_by_a_user(DeviceParameters device) {
  device.user = {0.554, 6.45, 135.0};
  return device;
}

inline DeviceParameters with_lag(DeviceParameters device, double time_constant) {
  device.actuator.time_constant = time_constant;
  return device;
}

inline DeviceParameters with_friction(DeviceParameters device, double motor, double handle) {
  device.bodies[0].coulomb = motor;
  device.bodies[1].coulomb = handle;
  return device;
}

inline HybridLoopOptions spring_wall(double stiffness, double damping = 0.0, double filter_hz = 0.0) {
  HybridLoopOptions options;
  options.controller.kind = ControllerOptions::Kind::wall;
  options.controller.stiffness = stiffness;
  options.controller.damping = damping;
  options.controller.velocity_filter_hz = filter_hz;
  return options;
}

inline HybridLoopOptions starting_at(HybridLoopOptions options, std::vector<double> positions,
                                     std::vector<double> velocities = {}) {
  options.initial_position = std::move(positions);
  options.initial_velocity = std::move(velocities);
  return options;
}

inline HybridLoopOptions pushed_by(HybridLoopOptions options, UserForce force) {
  options.user_force = std::move(force);
  return options;
}

/// The same loop as simulate() runs it.
inline SimulationOptions simulation_of(HybridLoopOptions loop, std::optional<double> duration = 1.0) {
  SimulationOptions options;
  options.controller = std::move(loop.controller);
  options.user_force = std::move(loop.user_force);
  options.faults = loop.faults;
  options.initial_position = std::move(loop.initial_position);
  options.initial_velocity = std::move(loop.initial_velocity);
  options.duration = duration;
  return options;
}

}  // namespace zwidth::test
