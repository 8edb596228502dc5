// A device described in C++, by zwidth::core alone: its limits, a slower motor bus, and the wall to render.
#include <cstdio>
#include <zwidth/core.hpp>

int main() {
  zwidth::DeviceParameters knob;
  knob.name = "direct-drive knob";
  knob.motion = zwidth::Motion::rotary;
  knob.bodies = {{.name = "rotor", .mass = 2e-5, .damping = 2e-4}};  // kg m2, N m s/rad
  knob.loop = {.sampling_period = 1e-3, .delay = 5e-4};              // s
  const zwidth::Device device(knob);

  const zwidth::HoldingLimits limits = zwidth::holding_limits(device);
  std::printf("any passive user: %.4g N m/rad, nobody holding: %.4g\n", limits.any_user->critical_stiffness,
              limits.nobody.critical_stiffness);
  const zwidth::Device later = device.with("loop.delay", 2e-3);
  std::printf("2 ms late: %.4g N m/rad\n", zwidth::holding_limits(later).any_user->critical_stiffness);
  const zwidth::WallRecommendation found = zwidth::recommend_wall(device);
  if (!found.wall) return 1;
  std::printf("wall to render: K = %.4g N m/rad, B = %.4g N m s/rad\n", *found.wall->wall.stiffness,
              found.wall->wall.damping);
  return found.trust.sound() ? 0 : 1;
}
