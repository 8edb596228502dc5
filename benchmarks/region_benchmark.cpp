// The region of stable walls of a two-mass loop: its boundary, a map of it, and the limit over all users beside it.

#include <benchmark/benchmark.h>

#include <vector>

#include "lhifam.hpp"
#include "zwidth/zwidth.hpp"

namespace {

using zwidth::Device;
using zwidth::StableWalls;

Device two_mass(double delay) { return Device(zwidth::test::with_delay(zwidth::test::lhifam_parameters(), delay)); }

struct Grid {
  std::vector<double> stiffnesses;
  std::vector<double> dampings;
};

Grid grid_over(const zwidth::StableRegion& region) {
  constexpr int count = 100;
  Grid grid;
  for (int i = 0; i < count; ++i) {
    grid.stiffnesses.push_back(1.1 * region.stiffest->stiffness * (i + 0.5) / count);
    grid.dampings.push_back(1.1 * region.most_damped->damping * (i + 0.5) / count);
  }
  return grid;
}

void boundary(benchmark::State& state, double delay, double velocity_filter_hz) {
  const Device device = two_mass(delay);
  for (auto _ : state) {
    const StableWalls walls(filtered_plant(device), velocity_filter_hz);
    benchmark::DoNotOptimize(stable_region(walls));
  }
}

// From the device to the map.
void raster_100_by_100(benchmark::State& state, double delay) {
  const Device device = two_mass(delay);
  const Grid grid = grid_over(stable_region(StableWalls(filtered_plant(device))));
  for (auto _ : state) {
    const StableWalls walls(filtered_plant(device));
    benchmark::DoNotOptimize(stable_on_grid(walls, grid.stiffnesses, grid.dampings));
  }
}

void any_user(benchmark::State& state, double delay) {
  const Device device = two_mass(delay);
  for (auto _ : state) benchmark::DoNotOptimize(absolute_stability_limit(device));
}

void absolute_stability_boundary(benchmark::State& state) {
  const Device device = two_mass(0.0);
  for (auto _ : state) {
    benchmark::DoNotOptimize(absolute_stability_region(device, StableWalls(filtered_plant(device)), 600.0));
  }
}

BENCHMARK_CAPTURE(boundary, two_mass, 0.0, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(boundary, two_mass_filter_100_hz, 0.0, 100.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(boundary, two_mass_delay_0_25_samples, 0.25e-3, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(boundary, two_mass_delay_8_25_samples, 8.25e-3, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(raster_100_by_100, two_mass, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(raster_100_by_100, two_mass_delay_0_25_samples, 0.25e-3)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(any_user, two_mass, 0.0)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(any_user, two_mass_delay_0_25_samples, 0.25e-3)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(any_user, two_mass_delay_8_25_samples, 8.25e-3)->Unit(benchmark::kMicrosecond);
BENCHMARK(absolute_stability_boundary)->Unit(benchmark::kMillisecond);

}  // namespace
