// The library's side of compare.py: one line per device file given, "critical_stiffness seconds_per_analysis".

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <ctime>

#include "zwidth/zwidth.hpp"

namespace {

constexpr int repetitions = 101;

/// Of the processor on this thread.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Median time of one analyze(), in seconds.
double median_seconds(const zwidth::Device& device) {
  std::array<double, repetitions> seconds{};
  for (double& time : seconds) {
    const double start = processor_seconds();
    [[maybe_unused]] const zwidth::Analysis analysis = zwidth::analyze(device, zwidth::limit_and_wall_only());
    time = processor_seconds() - start;
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
