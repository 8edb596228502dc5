// Reading a device: from TOML text to a checked Device.

#include <benchmark/benchmark.h>

#include <fstream>
#include <sstream>
#include <string>

#include "zwidth/io/device_file.hpp"

namespace {

void parse_device(benchmark::State& state) {
  std::ifstream file(ZWIDTH_SOURCE_DIR "/devices/lhifam.toml");
  std::ostringstream stream;
  stream << file.rdbuf();
  const std::string text = stream.str();
  for (auto _ : state) {
    const auto device = zwidth::parse_device(text, "lhifam.toml");
    if (!device) {
      state.SkipWithError(device.error().str().c_str());
      return;
    }
    benchmark::DoNotOptimize(device);
  }
}

BENCHMARK(parse_device)->Unit(benchmark::kMicrosecond);

}  // namespace
