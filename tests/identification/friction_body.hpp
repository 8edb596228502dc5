#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace zwidth::test {

/// A mass with viscous and Coulomb friction and a constant load, moved exactly through a time of constant force:
/// in closed form between reversals, which are met to the instant.
struct FrictionBody {
  double mass = 1.0;
  double viscous = 0.0;  // > 0
  double coulomb = 0.0;
  double offset = 0.0;
  double position = 0.0;
  double velocity = 0.0;

  void move(double force, double duration) {
    double left = duration;
    while (left > 0.0) {
      const double drive = force - offset;
      if (velocity == 0.0 && std::abs(drive) <= coulomb) return;  // sticks
      const double sign = velocity != 0.0 ? std::copysign(1.0, velocity) : std::copysign(1.0, drive);
      const double settled = (drive - sign * coulomb) / viscous;
      const double time_constant = mass / viscous;
      // v(t) = settled + (velocity - settled) e^(-t / time_constant)
      const double reversal = velocity * settled < 0.0 ? time_constant * std::log1p(-velocity / settled)
                                                       : std::numeric_limits<double>::infinity();
      const double time = std::min(left, reversal);
      const double decayed = -std::expm1(-time / time_constant);
      position += settled * time + (velocity - settled) * time_constant * decayed;
      velocity = reversal <= left ? 0.0 : velocity + (settled - velocity) * decayed;
      left -= time;
    }
  }
};

}  // namespace zwidth::test
