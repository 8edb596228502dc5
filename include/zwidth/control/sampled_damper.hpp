#pragma once

#include "zwidth/control/sampled_controller.hpp"
#include "zwidth/control/velocity_filter.hpp"

namespace zwidth {

/// The damper of a wall as it runs in a loop of its own: force from measured position, once per period of that loop.
///
///     F = -B v,  v by VelocityFilter
///
/// Positions in m or rad, forces in N or N m. In a unilateral wall F is 0 where the measured position does not lie beyond
/// the wall's; there the two forces may sum to one that pulls, which sum_of_paths() takes away.
/// After construction nothing allocates, locks, logs or throws, as in SampledController.
/// Source: docs/theory.md, "Two rates".
class SampledDamper {
 public:
  /// Takes damping, velocity filter, place and contact of the options; T of the damper's own loop, s, > 0.
  /// Throws Error (invalid_argument) for a damping, a filter or a period outside its range.
  SampledDamper(const ControllerOptions& options, double sampling_period);

  /// Force to command for this sample's measured position. The first call takes the device to be at rest.
  [[nodiscard]] double update(double measured) noexcept {
    const double force = -(damping_ * velocity_.update(measured));
    return one_sided_ && !(measured - position_ > 0.0) ? 0.0 : force;
  }

  /// Forgets the past: the next call is the first.
  void reset() noexcept { velocity_.reset(); }

 private:
  VelocityFilter velocity_;
  double damping_ = 0.0;
  double position_ = 0.0;
  bool one_sided_ = false;
};

/// The options of the spring, or the relay, that SampledController runs beside such a damper.
[[nodiscard]] ControllerOptions without_damper(ControllerOptions options);

/// What the actuator is to give of the two forces that have arrived, N or N m: their sum, that of a unilateral wall only
/// as far as it pushes.
[[nodiscard]] inline double sum_of_paths(double spring, double damper, bool is_unilateral_wall) noexcept {
  const double sum = spring + damper;
  return is_unilateral_wall && sum > 0.0 ? 0.0 : sum;
}

/// Whether the options are those of a unilateral wall.
[[nodiscard]] bool is_unilateral_wall(const ControllerOptions& options) noexcept;

}  // namespace zwidth
