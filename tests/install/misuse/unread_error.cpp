// What a device file gives is a device or an error: it is not a device before one has looked.

#include "zwidth/zwidth.hpp"

zwidth::Analysis analysis(const tl::expected<zwidth::Device, zwidth::InputError>& device) {
#ifdef MISUSE
  return zwidth::analyze(device);
#else
  return zwidth::analyze(*device);
#endif
}
