// The library's side of compare.py: one line per device file given, "critical_stiffness seconds_per_analysis".

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>

#include "zwidth/zwidth.hpp"

namespace {

constexpr int repetitions = 101;

/// Median time of one analyze(), in seconds.
double median_seconds(const zwidth::Device& device) {
  std::array<double, repetitions> seconds{};
  for (double& time : seconds) {
    const auto start = std::chrono::steady_clock::now();
    [[maybe_unused]] const zwidth::Analysis analysis = zwidth::analyze(device, zwidth::limit_and_wall_only());
    time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  std::nth_element(seconds.begin(), seconds.begin() + repetitions / 2, seconds.end());
  return seconds[repetitions / 2];
}

}  // namespace

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const auto device = zwidth::read_device_file(argv[i]);
    if (!device) {
      fmt::print(stderr, "{}\n", device.error().str());
      return 2;
    }
    fmt::print("{} {}\n", zwidth::analyze(*device, zwidth::limit_and_wall_only()).critical.stiffness,
               median_seconds(*device));
  }
}
