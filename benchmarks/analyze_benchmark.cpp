// Complete analyze(): from a device's parameters to its critical stiffness and everything that explains it.

#include <benchmark/benchmark.h>

#include "lhifam.hpp"
#include "zwidth/zwidth.hpp"

namespace {

using zwidth::Device;
using zwidth::DeviceParameters;
using namespace zwidth::test;

DeviceParameters three_mass() {
  DeviceParameters device = lhifam_parameters();
  device.bodies.push_back({.name = "tool", .mass = 0.4, .damping = 0.2});
  device.links.push_back({.first = 1, .second = 2, .stiffness = 20e3, .damping = 4.0});
  device.loop.held = 2;
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
    benchmark::DoNotOptimize(zwidth::analyze(device, zwidth::limit_and_wall_only()));
  }
}

BENCHMARK_CAPTURE(analyze, rigid, rigid_parameters())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyze, two_mass, lhifam_parameters())->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyze, two_mass_delay_8_samples, with_delay(lhifam_parameters(), 8e-3))
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyze, two_mass_delay_8_25_samples, with_delay(lhifam_parameters(), 8.25e-3))
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyze, two_mass_virtual_damper, with_virtual_damper(lhifam_parameters()))
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(analyze, three_mass, three_mass())->Unit(benchmark::kMicrosecond);

}  // namespace
