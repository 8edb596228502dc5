// What a design question costs beside the answer itself: all sensitivities, the branch switches, a sweep.

#include <benchmark/benchmark.h>

#include "lhifam.hpp"
#include "zwidth/zwidth.hpp"

namespace {

using zwidth::Device;
using zwidth::DeviceParameters;

Device two_mass(double delay) { return Device(zwidth::test::with_delay(zwidth::test::lhifam_parameters(), delay)); }

void critical_stiffness_alone(benchmark::State& state, double delay) {
  const Device device = two_mass(delay);
  for (auto _ : state) benchmark::DoNotOptimize(critical_stiffness(filtered_plant(device)));
}

// From the device: its critical stiffness and all its slopes.
void all_sensitivities(benchmark::State& state, double delay) {
  const Device device = two_mass(delay);
  for (auto _ : state) benchmark::DoNotOptimize(stiffness_sensitivities(device));
}

// At a crossover already found.
void all_sensitivities_at_the_crossover(benchmark::State& state, double delay) {
  const Device device = two_mass(delay);
  const zwidth::CriticalStiffness critical = critical_stiffness(filtered_plant(device));
  for (auto _ : state) benchmark::DoNotOptimize(stiffness_sensitivities(device, critical));
}

void all_absolute_stability_sensitivities(benchmark::State& state) {
  const Device device = two_mass(0.0);
  const zwidth::AbsoluteStabilityLimit limit = absolute_stability_limit(device);
  for (auto _ : state) benchmark::DoNotOptimize(absolute_stability_sensitivities(device, limit));
}

void all_branch_switches(benchmark::State& state) {
  const Device device = two_mass(0.0);
  for (auto _ : state) benchmark::DoNotOptimize(branch_switches(device));
}

void sweep_of_1000(benchmark::State& state) {
  const Device device = two_mass(0.0);
  for (auto _ : state) benchmark::DoNotOptimize(parameter_sweep(device, {{"loop.delay", 0.0, 8e-3, 1000}}));
}

BENCHMARK_CAPTURE(critical_stiffness_alone, two_mass, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(all_sensitivities, two_mass, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(all_sensitivities, two_mass_delay_0_25_samples, 0.25e-3)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(all_sensitivities_at_the_crossover, two_mass, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(all_sensitivities_at_the_crossover, two_mass_delay_0_25_samples, 0.25e-3)
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(all_absolute_stability_sensitivities)->Unit(benchmark::kMicrosecond);
BENCHMARK(all_branch_switches)->Unit(benchmark::kMillisecond);
BENCHMARK(sweep_of_1000)->Unit(benchmark::kMillisecond);

}  // namespace
