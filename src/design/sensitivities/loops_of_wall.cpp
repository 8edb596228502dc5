#include "design/sensitivities/loops_of_wall.hpp"

#include "zwidth/model/damper_timing.hpp"

namespace zwidth::internal {

bool has_two_loops(const Device& device) {
  const Wall& wall = device.parameters().wall;
  return has_damper_loop(device.loop()) && wall.damping > 0.0 && wall.stiffness != 0.0;
}

Device in_one_loop(const Device& device) {
  if (!has_damper_loop(device.loop()) || has_two_loops(device)) return device;
  return device.parameters().wall.damping == 0.0 ? with_one_rate(device) : with_loop_of_damper(device);
}

}  // namespace zwidth::internal
