#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/motion_residuals.hpp"
#include "identification/nonlinear_forces.hpp"
#include "identification/shot_device.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::internal {

/// What no number of the structure is, beside all numbers of a fit: a force that no device has, a mode that it lacks, clocks of
/// force and position that run apart, a damping that changes while it is recorded.
struct WeakForceEvidence {
  enum class Kind : std::uint8_t {
    drag,
    presliding,
    mode,
    clock_skew,
    link_friction,
    changing_damping
  } kind = Kind::drag;
  double ratio = 0.0;  ///< its size in deviations, > 0
  /// K_CR of the numbers fitted beside it, friction left out, and of a damping that changes at the worse end; NaN: no device
  /// has them.
  double stiffness_beside = 0.0;
  double frequency = 0.0;  ///< of a mode, rad/s
  double share = 0.0;      ///< of the response there, that the mode has
  double change = 0.0;     ///< of a delay (s) or a damping (N s/m or N m s/rad) over the record
  std::string body = {};   ///< of a damping
};

/// Drag in proportion to the square of a body's speed, in a record that a linear device was fitted to, at each body at which
/// it shows at all: c e of MotionResiduals is that of q |v_M| v_M; a mode (find_missing_mode())
/// and suspected_motions(). Nothing where the record is too short.
[[nodiscard]] std::vector<WeakForceEvidence> find_weak_forces(const MotionQuestion& question,
                                                              std::span<const double> force,
                                                              std::span<const double> position);

/// Of each recording of a fit in time: drag, and friction that does not reverse at once or is more as a body turns (six
/// lengths; of more than ContinuousMotion::max_friction_bodies bodies at those only that rub). Of the filtered residuals
/// of its shots, with the exact slopes of numbers, states and these forces, friction and all
/// (ShotModel::with_weak_forces()); then a mode and suspected_motions(), as the linear device moves. The band in rad/s.
[[nodiscard]] std::vector<std::vector<WeakForceEvidence>> find_weak_forces(const FittedDevice& fitted,
                                                                           const std::vector<std::string>& locked,
                                                                           double lowest, double highest);

/// What `source`, a record of a fit without them, shows: friction of another kind (significant_friction, in
/// deviations), drag (the same) beside which the critical stiffness is outside the interval, or that it hardly tells the
/// fitted numbers from one beside which that is lower. With its remedy.
[[nodiscard]] std::optional<Finding> doubt_of_weak_forces(std::span<const WeakForceEvidence> forces,
                                                          const Analysis& analysis, Motion motion,
                                                          const std::string& source);

}  // namespace zwidth::internal
