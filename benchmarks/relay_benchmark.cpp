// The relay experiments of Table II of Díaz & Gil: nine delays, four trials of 20 s each at 1 kHz, analysed.

#include <benchmark/benchmark.h>

#include "zwidth/model/device.hpp"
#include "zwidth/simulation/relay_experiment.hpp"
#include "zwidth/simulation/relay_prediction.hpp"

namespace {

using zwidth::Device;
using zwidth::DeviceParameters;

Device device_at(double delay) {
  DeviceParameters device;
  device.name = "LHIfAM, reduced pretension";
  device.bodies = {{.name = "motor", .mass = 0.3, .damping = 0.1},
                   {.name = "handle", .mass = 5.1, .damping = 3.4, .coulomb = 0.4}};
  device.links = {{.first = 0, .second = 1, .stiffness = 27.55e3, .damping = 10.5}};
  device.loop.held = 1;
  device.loop.sampling_period = 1e-3;
  device.loop.delay = delay + 250e-6;
  device.sensor.resolution = 3.14e-6;
  return Device(device);
}

void table_2(benchmark::State& state) {
  zwidth::RelayExperimentOptions options;
  options.relay.amplitude = 5.0;
  options.start_offset = 0.03;
  options.threads = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    for (int milliseconds = 0; milliseconds <= 8; ++milliseconds) {
      benchmark::DoNotOptimize(relay_experiment(device_at(1e-3 * milliseconds), options));
    }
  }
  state.SetItemsProcessed(state.iterations() * 36 * 20000);
}
BENCHMARK(table_2)->ArgName("threads")->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->UseRealTime();

void prediction(benchmark::State& state) {
  const Device device = device_at(4e-3);
  for (auto _ : state) benchmark::DoNotOptimize(relay_prediction(device, {5.0, 0.0}));
}
BENCHMARK(prediction)->Unit(benchmark::kMillisecond);

}  // namespace
