#pragma once

#include <optional>

#include "zwidth/control/velocity_filter.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/option_problem.hpp"

namespace zwidth {

/// Why the force of a rig went to zero.
enum class StopReason {
  none,            ///< it has not
  interrupted,     ///< SIGINT or SIGTERM
  not_a_number,    ///< a position or a force that is not finite
  position_limit,  ///< too far from where it started
  velocity_limit,
  saturation,     ///< more force was wanted than allowed for too long
  missed_cycles,  ///< too many in a row came late
  lost_link,      ///< too many in a row brought no position
  watchdog,       ///< the loop stood still, and another thread set the force to zero
  oscillation,    ///< it grew: this run alone ends
  wrong_sign,     ///< the device moved against the force that nudged it
  unknown_sign,   ///< the device did not move with the force that nudged it so that its sign is known
};

/// What a rig allows before its force goes to zero.
struct SafetyLimits {
  std::optional<double> force;        ///< N or N m; what is wanted beyond is cut off. Absent: none
  std::optional<double> position;     ///< m or rad, from where it started, either way. Absent: none
  std::optional<double> velocity;     ///< m/s or rad/s. Absent: none
  double saturation_duration = 0.25;  ///< s, of a force that is cut off; time within the limit is counted off it
  /// In a row: late by a period or more, or without a position. Absent: allowed_missed_cycles().
  std::optional<unsigned> missed_cycles = {};
  double ramp = 0.1;  ///< s, over which the force grows to its full size; 0: at once; <= 10
};

/// The first member outside its domain.
[[nodiscard]] std::optional<OptionProblem> find_problem(const SafetyLimits& limits);

/// How many cycles in a row may be missed where nobody says: 25 ms of them, three at least. An adapter that gathers bytes
/// for 16 ms has then handed on what was asked before.
///
/// `sampling_period` in s, > 0.
[[nodiscard]] unsigned allowed_missed_cycles(double sampling_period);

/// Why a drive's watchdog (s) would let go before the rig gives up: more cycles are allowed than it waits for. Three always
/// are.
[[nodiscard]] std::optional<OptionProblem> find_problem(const SafetyLimits& limits, double sampling_period,
                                                        double watchdog);

/// Judges every cycle of a rig: the force that may go out, or zero from then on.
///
/// Velocity is the backward difference through a low-pass of a twentieth of the sampling rate, so that single counts of
/// an encoder do not stop a rig. After construction nothing allocates, locks, logs or throws.
class ForceGuard {
 public:
  /// Throws Error (invalid_argument) where find_problem() finds one, and for a period that is not > 0.
  ForceGuard(const SafetyLimits& limits, double sampling_period);

  /// A cycle with a position: the force to command for the one wanted. 0 once stopped.
  [[nodiscard]] double update(double position, double wanted) noexcept;
  /// A cycle without a position: the last force, or 0 where that is one too many.
  [[nodiscard]] double no_position() noexcept;
  /// `cycles` were missed before this one; 0: it is in time.
  void missed(unsigned cycles) noexcept;
  /// Zero force from this call on; the first reason stays.
  void stop(StopReason reason) noexcept;
  /// The force grows from zero again. Positions still count from the first one.
  void restart() noexcept;

  /// Why the force is zero; none while it is not.
  [[nodiscard]] StopReason stopped() const noexcept { return reason_; }
  [[nodiscard]] double velocity() const noexcept { return velocity_; }  ///< m/s or rad/s, as the guard sees it
  /// The first position.
  [[nodiscard]] double origin() const noexcept { return origin_; }

 private:
  SafetyLimits limits_;
  VelocityFilter filter_;
  double ramp_step_ = 1.0;
  double saturated_most_ = 0.0;  // cycles
  unsigned missed_most_ = 0;
  StopReason reason_ = StopReason::none;
  bool started_ = false;
  double origin_ = 0.0;
  double velocity_ = 0.0;
  double share_ = 0.0;  // of the force, while it grows
  double last_ = 0.0;
  double saturated_ = 0.0;  // cycles beyond the limit, less those within it since
  unsigned without_position_ = 0;
  unsigned late_ = 0;
};

}  // namespace zwidth
