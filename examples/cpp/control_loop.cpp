// The wall as it runs in a real-time loop: force from position, once per sampling period.
// Here the device is a rigid mass under the wall's force; on hardware, read the encoder and command the amplifier instead.
#include <cmath>
#include <cstdio>
#include <zwidth/zwidth.hpp>

int main() {
  constexpr double period = 1e-3, mass = 5.4, damping = 3.5;
  zwidth::ControllerOptions wall;
  wall.kind = zwidth::ControllerOptions::Kind::wall;
  wall.stiffness = 2000.0;
  wall.damping = 20.0;
  wall.velocity_filter_hz = 100.0;
  if (const auto problem = zwidth::find_problem(wall, period))
    return std::fprintf(stderr, "%s\n", problem->member.c_str()), 2;
  zwidth::SampledController controller(wall, period);  // all that allocates or throws happens here

  const double kept = std::exp(-damping / mass * period);  // of the velocity, over one period
  double position = 1e-3, velocity = 0.0;
  for (int sample = 0; sample < 2000; ++sample) {
    const double force = controller.update(position);  // noexcept, no allocation
    const double settled = force / damping;
    const double reach = (velocity - settled) * (1.0 - kept) * mass / damping;
    position += settled * period + reach;
    velocity = settled + (velocity - settled) * kept;
  }
  std::printf("after 2 s: %.3g m\n", position);
  return std::abs(position) < 1e-4 ? 0 : 1;
}
