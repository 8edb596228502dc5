#pragma once

// Devices whose region is hard to follow: of dampings left at 0 or nearly so, and of many bodies.

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "property/random_devices.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::test {

/// 1 to 4 bodies; most dampings are the default 0.
inline DeviceParameters hardly_damped(RandomDevices& random) {
  DeviceParameters device;
  const std::size_t bodies = 1 + random.index(4);
  const auto damping = [&](double none, double low, double high) {
    return random.chance(none) ? 0.0 : random.log_uniform(low, high);
  };
  for (std::size_t i = 0; i < bodies; ++i) {
    const bool last = i + 1 == bodies;
    device.bodies.push_back(
        {"b" + std::to_string(i), random.log_uniform(0.02, 5.0), damping(last ? 0.2 : 0.8, 0.01, 10.0), 0.0, 0.0});
  }
  for (std::size_t i = 0; i + 1 < bodies; ++i) {
    device.links.push_back({i, i + 1, random.log_uniform(1e2, 3e7), damping(0.6, 1e-3, 30.0)});
  }
  device.loop.actuated = random.index(bodies);
  device.loop.sensed = random.chance(0.7) ? device.loop.actuated : random.index(bodies);
  device.loop.held = random.index(bodies);
  device.loop.sampling_period = std::array{1e-4, 5e-4, 1e-3, 2e-3}[random.index(4)];
  if (random.chance(0.5)) device.loop.delay = random.log_uniform(0.01, 3.0) * device.loop.sampling_period;
  return device;
}

/// The same with dampings down to 1e-8, springs to ground, lags, and delays of several samples.
inline DeviceParameters barely_damped(RandomDevices& random) {
  DeviceParameters device = hardly_damped(random);
  for (Body& body : device.bodies) {
    if (random.chance(0.5)) body.damping = random.log_uniform(1e-8, 1e-2);
    if (random.chance(0.1)) body.stiffness = random.log_uniform(1.0, 2000.0);
  }
  for (Link& link : device.links) {
    if (random.chance(0.3)) link.damping = random.log_uniform(1e-8, 1e-3);
  }
  if (random.chance(0.5)) device.loop.delay = random.uniform(0.0, 6.0) * device.loop.sampling_period;
  if (random.chance(0.15)) device.actuator.time_constant = random.log_uniform(0.05, 3.0) * device.loop.sampling_period;
  return device;
}

inline DeviceParameters long_chain(RandomDevices& random) {
  DeviceParameters device;
  const std::size_t bodies = 7 + random.index(4);
  for (std::size_t i = 0; i < bodies; ++i) {
    device.bodies.push_back(
        {"b" + std::to_string(i), random.log_uniform(0.02, 5.0), random.log_uniform(0.01, 10.0), 0.0, 0.0});
  }
  for (std::size_t i = 0; i + 1 < bodies; ++i) {
    device.links.push_back({i, i + 1, random.log_uniform(1e3, 3e5), random.log_uniform(0.1, 30.0)});
  }
  device.loop.held = bodies - 1;
  device.loop.sampling_period = std::array{5e-4, 1e-3, 2e-3}[random.index(3)];
  return device;
}

/// Alike or not, with dampings left at 0 here and there, actuated and sensed at any body, behind lags and delays.
inline DeviceParameters hardly_damped_chain(RandomDevices& random) {
  DeviceParameters device;
  const std::size_t bodies = 7 + random.index(4);
  const bool alike = random.chance(0.4);
  const double zero = alike ? 0.0 : 0.4;
  const auto damping = [&](double low, double high) {
    return random.chance(zero) ? 0.0 : random.log_uniform(low, high);
  };
  const Body body{"", random.log_uniform(0.03, 1.0), random.log_uniform(0.01, 2.0), 0.0, 0.0};
  const Link link{0, 1, random.log_uniform(1e3, 3e5), random.chance(0.3) ? 0.0 : random.log_uniform(0.05, 20.0)};
  for (std::size_t i = 0; i < bodies; ++i) {
    device.bodies.push_back(alike ? body : Body{"", random.log_uniform(0.02, 2.0), damping(0.01, 3.0), 0.0, 0.0});
    device.bodies.back().name = "b" + std::to_string(i);
  }
  for (std::size_t i = 0; i + 1 < bodies; ++i) {
    device.links.push_back(alike ? link : Link{0, 1, random.log_uniform(1e3, 1e6), damping(0.02, 30.0)});
    device.links.back().first = i;
    device.links.back().second = i + 1;
  }
  device.bodies.front().damping = std::max(device.bodies.front().damping, 0.01);
  device.loop.held = bodies - 1;
  device.loop.sensed = std::array{std::size_t{0}, bodies - 1, random.index(bodies)}[random.index(3)];
  if (random.chance(0.3)) device.loop.actuated = random.index(bodies);
  device.loop.sampling_period = random.log_uniform(1e-4, 5e-3);
  if (random.chance(0.5)) device.loop.delay = random.log_uniform(0.01, 3.0) * device.loop.sampling_period;
  if (random.chance(0.2)) device.actuator.time_constant = random.log_uniform(1e-4, 3e-3);
  return device;
}

}  // namespace zwidth::test
