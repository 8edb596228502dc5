// Complete analyze(): from a device's parameters to its critical stiffness and everything that explains it.

#include <benchmark/benchmark.h>

#include "zwidth/zwidth.hpp"

namespace {

using zwidth::Device;
using zwidth::DeviceParameters;

DeviceParameters rigid() {
  DeviceParameters device;
  device.name = "rigid";
  device.bodies = {{.name = "body", .mass = 5.4, .damping = 3.5}};
  device.loop.sampling_period = 1e-3;
  return device;
}

DeviceParameters two_mass() {
  DeviceParameters device;
  device.name = "LHIfAM";
  device.bodies = {{.name = "motor", .mass = 0.3, .damping = 0.1}, {.name = "handle", .mass = 5.1, .damping = 3.4}};
  device.links = {{.first = 0, .second = 1, .stiffness = 79.5e3, .damping = 15.0}};
  device.loop.held = 1;
  device.loop.sampling_period = 1e-3;
  return device;
}

DeviceParameters three_mass() {
  DeviceParameters device = two_mass();
  device.bodies.push_back({.name = "tool", .mass = 0.4, .damping = 0.2});
  device.links.push_back({.first = 1, .second = 2, .stiffness = 20e3, .damping = 4.0});
  device.loop.held = 2;
  return device;
}

DeviceParameters with_delay(DeviceParameters device, double samples) {
  device.loop.delay = samples * device.loop.sampling_period;
  return device;
}

DeviceParameters with_virtual_damper(DeviceParameters device) {
  device.wall.damping = 5.0;
  device.wall.velocity_filter_hz = 100.0;
  return device;
}

void analyze(benchmark::State& state, const DeviceParameters& parameters) {
  const Device device(parameters);
  for (auto _ : state) {
    benchmark::DoNotOptimize(zwidth::analyze(device));
  }
}

BENCHMARK_CAPTURE(analyze, rigid, rigid())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyze, two_mass, two_mass())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyze, two_mass_delay_8_samples, with_delay(two_mass(), 8.0))->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyze, two_mass_delay_8_25_samples, with_delay(two_mass(), 8.25))->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyze, two_mass_virtual_damper, with_virtual_damper(two_mass()))->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyze, three_mass, three_mass())->Unit(benchmark::kMicrosecond);

}  // namespace
