#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "zwidth/control/running_filter.hpp"
#include "zwidth/control/velocity_filter.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth {

/// Force from position, once per sampling period: none, a virtual wall, or a relay.
struct ControllerOptions {
  /// What the actuator is commanded by.
  enum class Kind { none, wall, relay };
  Kind kind = Kind::none;  ///< nothing: the actuator rests

  // Wall: C(z) = F(z) (K + B v(z)) on the penetration of the measured position into `position`.
  double stiffness = 0.0;                ///< K, N/m or N m/rad; >= 0
  double damping = 0.0;                  ///< B, N s/m or N m s/rad; >= 0; a relay has none, but one that runs apart
  double velocity_filter_hz = 0.0;       ///< f_c; 0: none
  std::vector<WallFilter> filters = {};  ///< F: on the whole force, in the order in which they run; at most 20
  double position = 0.0;                 ///< where the wall begins, m or rad; it fills all beyond
  /// On which side of its surface a wall acts.
  enum class Contact {
    bilateral,   ///< a spring on both sides: the linear loop
    unilateral,  ///< what enters the filters is 0 outside the wall and never pulls; what leaves them never pulls
  };
  Contact contact = Contact::bilateral;  ///< both sides, as the linear theory has it

  // Relay: -amplitude where the measured position lies above `position` + hysteresis, +amplitude below
  // `position` - hysteresis, unchanged in between (and exactly at `position`).
  double amplitude = 0.0;   ///< N or N m; > 0
  double hysteresis = 0.0;  ///< m or rad; >= 0
};

/// The wall of a device file as a bilateral spring at 0; without wall.stiffness, K = 0.
[[nodiscard]] ControllerOptions wall_controller(const Wall& wall);

/// The first member outside its domain, at this sampling period in s (a notch lies below Nyquist's frequency).
[[nodiscard]] std::optional<OptionProblem> find_problem(const ControllerOptions& options, double sampling_period);

/// The controller as it runs on a device: force from measured position, once per sampling period.
///
///     wall:   F = -F(z) (K (x - x_w) + B v),  v by VelocityFilter, F(z) by RunningFilter one after the other
///     relay:  F = -+d, see ControllerOptions
///
/// Positions in m or rad, forces in N or N m.
/// After construction nothing allocates, locks, logs or throws: the same object serves the simulation and a real-time
/// loop. A NaN measured gives NaN, and may stay in the filters: stop, or reset().
/// Source: eqs. 17-19 of Díaz & Gil.
class SampledController {
 public:
  /// Throws Error (invalid_argument) with member and value where find_problem() finds one, and for a period that is
  /// not > 0.
  SampledController(const ControllerOptions& options, double sampling_period);

  /// Force to command for this sample's measured position. The first call takes the device to be at rest.
  [[nodiscard]] double update(double measured) noexcept;

  /// Forgets the past: the next call is the first.
  void reset() noexcept;

 private:
  [[nodiscard]] double wall_force(double measured) noexcept;
  [[nodiscard]] double relay_force(double measured) noexcept;

  ControllerOptions options_;
  VelocityFilter velocity_;
  std::array<RunningFilter, max_wall_filters> filters_{};
  std::size_t filter_count_ = 0;
  double relay_force_ = 0.0;
};

}  // namespace zwidth
