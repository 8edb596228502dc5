// usage: random_device_files FOLDER COUNT      writes COUNT random devices, of every kind in turn, as device files

#include <cstdlib>
#include <fstream>
#include <string>

#include "property/random_devices.hpp"
#include "zwidth/io/device_file.hpp"

int main(int argument_count, char** arguments) {
  if (argument_count != 3) return 2;
  constexpr std::uint64_t seed = 20261122;
  zwidth::test::RandomDevices random(seed);
  const int count = std::atoi(arguments[2]);
  for (int i = 0; i < count; ++i) {
    const auto kind = zwidth::test::device_kinds[static_cast<std::size_t>(i) % zwidth::test::device_kinds.size()];
    const std::string text = zwidth::write_device(random.device(kind));
    std::ofstream(std::string(arguments[1]) + "/" + std::to_string(i) + ".toml") << text;
  }
  return 0;
}
