// The library's side of compare_region.py: prints the seconds of each repetition, from the device to a map of
// COUNT x COUNT walls up to STIFFNESS and DAMPING, and writes the map, a byte per wall, rows by rising damping.

#include <fmt/core.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "zwidth/design/stable_walls.hpp"
#include "zwidth/io/device_file.hpp"

int main(int argc, char** argv) {
  if (argc != 7) {
    fmt::print(stderr, "usage: zwidth_region DEVICE STIFFNESS DAMPING COUNT REPETITIONS MAP\n");
    return 2;
  }
  const auto device = zwidth::read_device_file(argv[1], {});
  if (!device) {
    fmt::print(stderr, "{}\n", device.error().str());
    return 2;
  }
  const auto count = static_cast<std::size_t>(std::strtoull(argv[4], nullptr, 10));
  std::vector<double> stiffnesses;
  std::vector<double> dampings;
  for (std::size_t i = 0; i < count; ++i) {
    const double middle = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    stiffnesses.push_back(std::strtod(argv[2], nullptr) * middle);
    dampings.push_back(std::strtod(argv[3], nullptr) * middle);
  }
  std::vector<std::uint8_t> map;
  for (int i = 0; i < std::atoi(argv[5]); ++i) {
    const auto start = std::chrono::steady_clock::now();
    const zwidth::StableWalls walls(filtered_plant(*device));
    map = stable_on_grid(walls, stiffnesses, dampings);
    fmt::print("{}\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::ofstream file(argv[6], std::ios::binary);
  file.write(reinterpret_cast<const char*>(map.data()), static_cast<std::streamsize>(map.size()));
  return file ? 0 : 1;
}
