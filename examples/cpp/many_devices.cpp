// The limit over a thousand cables, on all cores. usage: many_devices DEVICE.toml
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>
#include <zwidth/zwidth.hpp>

int main(int count, char** words) {
  if (count != 2) return std::fprintf(stderr, "usage: many_devices DEVICE.toml\n"), 2;
  const auto device = zwidth::read_device_file(words[1]);
  if (!device) return std::fprintf(stderr, "%s\n", device.error().str().c_str()), 2;
  std::vector<zwidth::ParameterValues> changes(1);
  changes[0].key = "link.0.stiffness";
  for (int i = 0; i < 1000; ++i) changes[0].values.push_back(1e4 * std::pow(100.0, i / 999.0));
  double least = INFINITY;
  for (const zwidth::CriticalStiffnessOfOne& one : zwidth::critical_stiffness_many(*device, changes)) {
    if (!one.failure.empty()) std::fprintf(stderr, "%s\n", one.failure.c_str());
    if (one.status == zwidth::StiffnessStatus::finite) least = std::min(least, one.stiffness);
  }
  std::printf("least limit of 1000 cables: %.6g\n", least);
  return std::isfinite(least) ? 0 : 1;
}
