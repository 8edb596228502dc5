// The library's side of compare_batch.py, on one core: batch_stiffness() by the kernel and one by one, of rigid and
// two-mass devices without and with delay. A line each: name, seconds per device of both, share that the kernel left to
// the library. With a folder also the two-mass devices and their critical stiffnesses, as doubles.

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <random>
#include <string>
#include <tuple>
#include <vector>

#include "zwidth/zwidth.hpp"

namespace {

constexpr int repetitions = 9;
constexpr std::size_t devices_one_by_one = 2000;

std::vector<zwidth::ParameterValues> around(const zwidth::Device& device, const std::vector<std::string>& keys,
                                            std::size_t count) {
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> share(0.8, 1.25);
  std::vector<zwidth::ParameterValues> changes;
  for (const std::string& key : keys) {
    const double value = *zwidth::parameter(device.parameters(), key);
    changes.push_back({key, {}});
    for (std::size_t i = 0; i < count; ++i) changes.back().values.push_back(value * share(engine));
  }
  return changes;
}

/// Median seconds of the processor per device.
double seconds(const zwidth::Device& device, const std::vector<zwidth::ParameterValues>& changes, bool vectorised,
               zwidth::BatchStiffness& columns) {
  std::array<double, repetitions> times{};
  for (double& time : times) {
    const std::clock_t start = std::clock();
    columns = zwidth::batch_stiffness(device, changes, {.any_user = false, .threads = 1, .vectorised = vectorised});
    time = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  }
  std::nth_element(times.begin(), times.begin() + repetitions / 2, times.end());
  return times[repetitions / 2] / static_cast<double>(columns.size());
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t count = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 100000;
  zwidth::DeviceParameters rigid;
  rigid.name = "rigid";
  rigid.bodies = {{"body", 5.4, 3.5, 0.0, 0.0}};
  rigid.loop.sampling_period = 1e-3;
  zwidth::DeviceParameters two_mass = rigid;  // Table I of Díaz & Gil
  two_mass.bodies = {{"motor", 0.3, 0.1, 0.0, 0.0}, {"handle", 5.1, 3.4, 0.0, 0.0}};
  two_mass.links = {{0, 1, 79.5e3, 15.0}};
  two_mass.loop.held = 1;
  zwidth::DeviceParameters delayed = two_mass;
  delayed.loop.delay = 8.25e-3;
  const std::vector<std::string> of_two{"body.motor.mass",     "body.handle.mass", "body.motor.damping",
                                        "body.handle.damping", "link.stiffness",   "link.damping"};
  for (const auto& [name, parameters, keys] :
       {std::tuple{"rigid", rigid, std::vector<std::string>{"body.body.mass", "body.body.damping"}},
        std::tuple{"two_mass", two_mass, of_two}, std::tuple{"two_mass_delay", delayed, of_two}}) {
    const zwidth::Device device(parameters);
    std::vector<zwidth::ParameterValues> changes = around(device, keys, count);
    zwidth::BatchStiffness columns;
    const double by_kernel = seconds(device, changes, true, columns);
    if (argc > 2 && std::string(name) == "two_mass") {
      std::ofstream file(std::string(argv[2]) + "/devices", std::ios::binary);
      const auto write = [&](const std::vector<double>& values) {
        file.write(reinterpret_cast<const char*>(values.data()),
                   static_cast<std::streamsize>(values.size() * sizeof(double)));
      };
      for (const zwidth::ParameterValues& each : changes) write(each.values);
      write(columns.stiffness);
    }
    const double share = static_cast<double>(columns.scalar_count) / static_cast<double>(columns.size());
    for (zwidth::ParameterValues& each : changes) each.values.resize(std::min(count, devices_one_by_one));
    fmt::print("{} {} {} {}\n", name, by_kernel, seconds(device, changes, false, columns), share);
  }
}
