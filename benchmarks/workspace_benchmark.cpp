// The limits over a workspace: items are poses times directions, on all cores, with nobody and any passive user both.

#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "zwidth/zwidth.hpp"

namespace {

void workspace_of(benchmark::State& state, const char* name, const std::vector<zwidth::PoseAxis>& grid) {
  const auto device = zwidth::read_device_file(std::string(ZWIDTH_SOURCE_DIR "/devices/mechanisms/") + name + ".toml");
  if (!device) {
    state.SkipWithError("no mechanisms in this build");
    return;
  }
  std::size_t limits = 0;
  for (auto _ : state) limits += zwidth::workspace(*device, {.grid = grid}).directions;
  state.SetItemsProcessed(static_cast<std::int64_t>(limits));
}

BENCHMARK_CAPTURE(workspace_of, planar_arm, "planar_arm", {{"shoulder", 0.0, 1.5, 4}, {"elbow", 0.35, 2.6, 10}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(workspace_of, phantom_premium, "phantom_premium",
                  {{"base", -0.5, 0.5, 2}, {"upper", -0.4, 0.6, 4}, {"fore", -0.5, 0.5, 4}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();
BENCHMARK_CAPTURE(workspace_of, pantograph, "pantograph", {{"theta1", 0.5, 1.2, 6}, {"theta5", 1.9, 2.6, 6}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
