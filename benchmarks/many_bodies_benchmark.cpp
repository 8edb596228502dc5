// What devices of many bodies cost: a hundred analysed, six designed and diagnosed, ten aimed at a limit with any user.

#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>

#include "property/random_devices.hpp"
#include "zwidth/zwidth.hpp"

namespace {

using namespace zwidth;

enum class Shape { chain, tree };

// With dampings of the usual size; hung behind one of the four bodies before it where it is a tree.
Device many_bodies(std::size_t bodies, Shape shape, std::uint64_t seed) {
  test::RandomDevices random(seed);
  DeviceParameters device;
  for (std::size_t i = 0; i < bodies; ++i) {
    device.bodies.push_back(
        {"b" + std::to_string(i), random.log_uniform(0.1, 3.0), random.log_uniform(0.01, 5.0), 0.0, 0.0});
    if (i == 0) continue;
    const std::size_t nearest = i > 4 ? i - 4 : 0;
    const std::size_t parent = shape == Shape::tree ? nearest + random.index(i - nearest) : i - 1;
    device.links.push_back({parent, i, random.log_uniform(3e3, 1e6), random.log_uniform(0.1, 20.0)});
  }
  device.loop.sampling_period = 1e-3;
  device.loop.delay = 0.3e-3;
  device.loop.held = bodies - 1;
  device.wall.stiffness = 300.0;
  device.wall.damping = 5.0;
  return Device(device);
}

void analysis(benchmark::State& state, std::size_t bodies, Shape shape) {
  const Device device = many_bodies(bodies, shape, 1);
  for (auto _ : state) benchmark::DoNotOptimize(analyze(device));
}

void whole_design(benchmark::State& state, std::size_t bodies, Shape shape) {
  const Device device = many_bodies(bodies, shape, 1);
  for (auto _ : state) benchmark::DoNotOptimize(design(device));
}

void diagnosis(benchmark::State& state, std::size_t bodies, Shape shape) {
  const Device device = many_bodies(bodies, shape, 1);
  const double stiffness = 1.5 * absolute_stability_limit(device, virtual_damper(device)).stiffness;
  for (auto _ : state) {
    benchmark::DoNotOptimize(
        diagnose(device, {.frequency = 2.0 * std::numbers::pi * 40.0, .amplitude = {}, .stiffness = stiffness}));
  }
}

void target_of_absolute_stability(benchmark::State& state, std::size_t bodies, Shape shape) {
  const Device device = many_bodies(bodies, shape, 1);
  DesignTargetOptions options;
  options.goal = StiffnessGoal::absolute_stability_limit;
  options.stiffness = 1.5 * absolute_stability_limit(device, virtual_damper(device)).stiffness;
  for (auto _ : state) benchmark::DoNotOptimize(design_targets(device, options));
}

BENCHMARK_CAPTURE(analysis, chain_of_6, 6, Shape::chain)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(analysis, tree_of_20, 20, Shape::tree)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(analysis, chain_of_100, 100, Shape::chain)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(analysis, tree_of_100, 100, Shape::tree)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(whole_design, chain_of_6, 6, Shape::chain)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(whole_design, tree_of_6, 6, Shape::tree)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(diagnosis, chain_of_6, 6, Shape::chain)->Unit(benchmark::kMillisecond)->Iterations(1);
BENCHMARK_CAPTURE(target_of_absolute_stability, chain_of_10, 10, Shape::chain)
    ->Unit(benchmark::kMillisecond)
    ->Iterations(1);

}  // namespace
