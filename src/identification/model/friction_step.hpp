#pragma once

namespace zwidth::internal {

/// A body's velocity at the end of a step with dry friction, and how it changes.
struct FrictionStep {
  double velocity = 0.0;
  double by_before = 0.0;      ///< d velocity / d velocity at the step's beginning
  double by_free = 0.0;        ///< ... / d velocity at its end without friction
  double by_limit = 0.0;       ///< ... / d limit
  double by_compliance = 0.0;  ///< ... / d compliance
};

/// Coulomb's law over one step in closed form, all other forces constant: the body slides, stops and sticks, or turns round.
///
///     g = (free - before) / compliance: the other forces;  |g| <= limit: it slides until it stops, and sticks
///     |g| > limit, against the motion: it stops after the share |before| / (compliance (|g| + limit)) and goes on the other way
///
/// `compliance`: velocity at the end by a constant force on the body, about length / mass. Exact for a rigid body.
[[nodiscard]] FrictionStep friction_step(double before, double free, double limit, double compliance);

}  // namespace zwidth::internal
