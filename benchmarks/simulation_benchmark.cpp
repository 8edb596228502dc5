// Samples per second of the loop in time; one core.

#include <benchmark/benchmark.h>

#include <numbers>

#include "lhifam.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/simulation/hybrid_loop.hpp"

namespace {

using zwidth::Device;
using zwidth::DeviceParameters;
using zwidth::HybridLoop;
using zwidth::HybridLoopOptions;
using zwidth::test::lhifam_parameters;

DeviceParameters two_mass_fractional_delay() {
  DeviceParameters device = lhifam_parameters();
  device.loop.delay = 2.25e-3;
  return device;
}

DeviceParameters friction_and_encoder() {
  DeviceParameters device = lhifam_parameters();
  device.bodies[0].coulomb = 0.02;
  device.bodies[1].coulomb = 0.05;
  device.sensor.resolution = 3.14e-6;
  return device;
}

HybridLoopOptions wall(double stiffness) {
  HybridLoopOptions options;
  options.controller.kind = zwidth::ControllerOptions::Kind::wall;
  options.controller.stiffness = stiffness;
  options.initial_position = {3e-3, 3e-3};
  return options;
}

HybridLoopOptions held_in_motion(double stiffness) {
  HybridLoopOptions options = wall(stiffness);
  options.user_force.kind = zwidth::UserForce::Kind::sine;
  options.user_force.amplitude = 5.0;
  options.user_force.frequency = 2.0 * std::numbers::pi * 3.0;
  return options;
}

HybridLoopOptions with_faults(double stiffness) {
  HybridLoopOptions options = wall(stiffness);
  options.faults.lost_sample_probability = 0.05;
  options.faults.sampling_jitter = 2e-4;
  return options;
}

void step(benchmark::State& state, const DeviceParameters& device, const HybridLoopOptions& options) {
  HybridLoop loop(Device(device), options);
  constexpr int samples = 10000;  // a run of 10 s, started anew each time
  for (auto _ : state) {
    loop.reset();
    for (int k = 0; k < samples; ++k) loop.step();
    benchmark::DoNotOptimize(loop.sensed_position());
  }
  state.SetItemsProcessed(state.iterations() * samples);
  state.counters["stick_slip_per_s"] = static_cast<double>(loop.friction_events()) / 10.0;
}

BENCHMARK_CAPTURE(step, two_mass, lhifam_parameters(), wall(5000.0))->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, two_mass_fractional_delay, two_mass_fractional_delay(), wall(900.0))
    ->Unit(benchmark::kMicrosecond);
// A user keeps it moving: it would come to rest, where nothing happens, within a second.
BENCHMARK_CAPTURE(step, friction_on_both_and_encoder, friction_and_encoder(), held_in_motion(5000.0))
    ->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(step, lost_samples_and_jitter, lhifam_parameters(), with_faults(5000.0))
    ->Unit(benchmark::kMicrosecond);

}  // namespace
