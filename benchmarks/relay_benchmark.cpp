// The relay experiments of Table II of Díaz & Gil: nine delays, four trials of 20 s each at 1 kHz, analysed.

#include <benchmark/benchmark.h>

#include "lhifam.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/simulation/relay_prediction.hpp"
#include "zwidth/simulation/relay_trials.hpp"

namespace {

using zwidth::Device;
using zwidth::DeviceParameters;

Device device_at(double delay) {
  DeviceParameters device = zwidth::test::reduced_pretension_parameters();
  device.bodies[1].coulomb = 0.4;
  device.loop.delay = delay + 250e-6;
  device.sensor.resolution = 3.14e-6;
  return Device(device);
}

void table_2(benchmark::State& state) {
  zwidth::RelayOptions options;
  options.relay.amplitude = 5.0;
  options.start_offset = 0.03;
  options.threads = static_cast<std::size_t>(state.range(0));
  for (auto _ : state) {
    for (int milliseconds = 0; milliseconds <= 8; ++milliseconds) {
      benchmark::DoNotOptimize(relay_trials(device_at(1e-3 * milliseconds), options));
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
