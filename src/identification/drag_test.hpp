#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "identification/motion_residuals.hpp"
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

/// What `source`, a record of a fit without drag, shows in words: drag (significant_friction, in deviations) beside which the
/// critical stiffness is outside the interval, or that it hardly tells damping from drag beside which that is lower.
[[nodiscard]] std::optional<std::string> doubt_of_drag(std::span<const DragEvidence> drags, const Analysis& analysis,
                                                       Motion motion, const std::string& source);

}  // namespace zwidth::internal
