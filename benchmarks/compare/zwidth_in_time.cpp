// The library's side of in_time.py: zwidth_in_time DEVICE_FILE START SAMPLES simulates the device against its own wall
// from START (m or rad, all bodies) and prints "seconds_per_sample", then the position of every body at the end.

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "zwidth/zwidth.hpp"

namespace {

constexpr int repetitions = 101;

/// Median time of one run, per sample, in seconds.
double median_seconds(zwidth::HybridLoop& loop, int samples) {
  std::array<double, repetitions> seconds{};
  for (double& time : seconds) {
    loop.reset();
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < samples; ++k) loop.step();
    time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  std::nth_element(seconds.begin(), seconds.begin() + repetitions / 2, seconds.end());
  return seconds[repetitions / 2] / samples;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    fmt::print(stderr, "usage: zwidth_in_time DEVICE_FILE START SAMPLES\n");
    return 2;
  }
  const auto device = zwidth::read_device_file(argv[1]);
  const int samples = std::atoi(argv[3]);
  if (!device || samples < 1) {
    fmt::print(stderr, "{}\n", device ? "SAMPLES must be at least 1" : device.error().str());
    return 2;
  }
  zwidth::HybridLoopOptions options;
  options.controller = zwidth::wall_controller(device->parameters().wall);
  options.initial_position.assign(device->bodies().size(), std::atof(argv[2]));
  zwidth::HybridLoop loop(*device, options);
  fmt::print("{}", median_seconds(loop, samples));
  for (std::size_t i = 0; i < device->bodies().size(); ++i) fmt::print(" {:.17g}", loop.position(i));
  fmt::print("\n");
}
