// What a recommendation costs, for two-body and other devices.

#include <benchmark/benchmark.h>

#include "lhifam.hpp"
#include "zwidth/zwidth.hpp"

namespace {

void recommendation(benchmark::State& state, const char* file, zwidth::WallGoal goal, double quantisation_force) {
  const zwidth::Device device = zwidth::read_device_file(std::string(ZWIDTH_SOURCE_DIR "/devices/") + file).value();
  zwidth::RecommendationOptions options;
  options.goal = goal;
  if (quantisation_force > 0.0) options.quantisation_force = quantisation_force;
  for (auto _ : state) benchmark::DoNotOptimize(recommend_wall(device, options));
}

using enum zwidth::WallGoal;
BENCHMARK_CAPTURE(recommendation, rigid, "emps.toml", stiffness, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recommendation, two_mass, "lhifam.toml", stiffness, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recommendation, two_mass_ripple, "lhifam.toml", stiffness, 0.1)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recommendation, two_mass_damped, "lhifam.toml", critical_damping, 0.0)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recommendation, handle_sensed, "lhifam_handle_sensed.toml", stiffness, 0.1)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(recommendation, two_mass_drive, "two_mass_drive.toml", stiffness, 0.0)->Unit(benchmark::kMillisecond);

}  // namespace
