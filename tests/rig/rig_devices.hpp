#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <string>

#include "zwidth/model/device.hpp"

namespace zwidth::test {

/// Devices as they stand on benches: one body or two, linear or rotary, with delay, lag and an encoder, some.
inline Device bench_device(std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  const auto uniform = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  };
  const auto log_uniform = [&](double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); };
  DeviceParameters parameters;
  parameters.name = "bench device " + std::to_string(seed);
  parameters.motion = seed % 3 == 0 ? Motion::rotary : Motion::linear;
  const double mass = parameters.motion == Motion::rotary ? log_uniform(1e-4, 1e-2) : log_uniform(0.05, 3.0);
  parameters.bodies.push_back({"motor", mass, mass * log_uniform(0.5, 20.0), 0.0, 0.0});
  if (seed % 2 == 0) {
    const double handle = mass * log_uniform(0.2, 5.0);
    parameters.bodies.push_back({"handle", handle, handle * log_uniform(0.5, 10.0), 0.0, 0.0});
    const double reduced = mass * handle / (mass + handle);
    const double resonance = 6.283185307179586 * log_uniform(25.0, 120.0);
    parameters.links.push_back(
        {0, 1, reduced * resonance * resonance, 2.0 * uniform(0.01, 0.08) * reduced * resonance});
  }
  parameters.loop.held = parameters.bodies.size() - 1;
  parameters.loop.sampling_period = 1e-3;
  if (seed % 4 >= 2) parameters.loop.delay = uniform(0.0, 2e-3);
  if (seed % 5 == 0) parameters.actuator.time_constant = log_uniform(1e-4, 1e-3);
  return Device(parameters);
}

}  // namespace zwidth::test
