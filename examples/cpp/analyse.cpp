// The limit of a device, what sets it, and what it is worth. usage: analyse DEVICE.toml
#include <cstdio>
#include <zwidth/zwidth.hpp>

int main(int count, char** words) {
  if (count != 2) return std::fprintf(stderr, "usage: analyse DEVICE.toml\n"), 2;
  const auto device = zwidth::read_device_file(words[1]);
  if (!device) return std::fprintf(stderr, "%s\n", device.error().str().c_str()), 2;
  const zwidth::Analysis analysis = zwidth::analyze(*device);
  for (const std::string& reason : analysis.trust.reasons) std::fprintf(stderr, "not sure: %s\n", reason.c_str());
  if (analysis.critical.status != zwidth::StiffnessStatus::finite) return std::puts("no finite limit"), 0;
  std::printf("stable below %.15g\n", analysis.critical.stiffness);
  if (analysis.any_user) std::printf("with any passive user below %.15g\n", analysis.any_user->stiffness);
}
