#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/motion_residuals.hpp"
#include "identification/nonlinear_forces.hpp"
#include "identification/shot_device.hpp"
#include "zwidth/stability/analysis.hpp"

namespace zwidth::internal {

/// Drag in proportion to the square of a body's speed, beside all numbers of a fit.
struct DragEvidence {
  double ratio = 0.0;             ///< its size in deviations, > 0
  double stiffness_beside = 0.0;  ///< K_CR of the numbers fitted beside it, friction left out; NaN: no device has them
};

/// Of a record that a linear device was fitted to, at each body at which it shows at all: c e of MotionResiduals is that of
/// q |v_M| v_M. Nothing where the record is too short.
[[nodiscard]] std::vector<DragEvidence> find_drag(const MotionQuestion& question, std::span<const double> force,
                                                  std::span<const double> position);

/// The same of each recording of a fit in time: of the filtered residuals of its shots, with the exact slopes of numbers,
/// states and drag, friction and all (ShotModel::with_drag()). The band in rad/s.
[[nodiscard]] std::vector<std::vector<DragEvidence>> find_drag(const FittedDevice& fitted,
                                                               const std::vector<std::string>& locked, double lowest,
                                                               double highest);

/// The clearest that shows, by `significant` deviations and more, and beside which the critical stiffness is outside the
/// interval.
[[nodiscard]] std::optional<Nonlinearity> drag_that_matters(std::span<const DragEvidence> drags, double significant,
                                                            const Analysis& analysis, Motion motion);

/// For drag_that_matters(). With the friction left out, of records that have some: of 70 linear ones 1.8 at most, of 70 with friction 3.9.
inline constexpr double significant_drag = 4.8;
/// With the friction played: of NNN linear records with friction N at most.
inline constexpr double significant_drag_in_time = 3.5;

}  // namespace zwidth::internal
