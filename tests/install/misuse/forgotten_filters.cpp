// The wall's filters belong to the loop: a limit of the bare sampled plant would leave them out unsaid.

#include "zwidth/zwidth.hpp"

zwidth::LoopMargins margins(const zwidth::Device& device) {
#ifdef MISUSE
  return zwidth::loop_margins(zwidth::sampled_plant(device), device.parameters().wall);
#else
  return zwidth::loop_margins(zwidth::filtered_plant(device), device.parameters().wall);
#endif
}
