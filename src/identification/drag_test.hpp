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
  std::string body;
  double ratio = 0.0;             ///< its size in deviations, > 0
  double stiffness_beside = 0.0;  ///< K_CR of the numbers fitted beside it, friction left out; NaN: no device has them
};

/// Looks for drag in a record that a linear device was fitted to: c e of MotionResiduals is that of q |v_M| v_M at the body
/// at which it explains most. Nothing where the record is too short, or shows no drag at all.
[[nodiscard]] std::optional<DragEvidence> find_drag(const MotionQuestion& question, std::span<const double> force,
                                                    std::span<const double> position);

/// The same in the recording `record` of a fit in time, at the sensed body: of the filtered residuals of its shots, with the
/// exact slopes of numbers and states. The band in rad/s.
[[nodiscard]] std::optional<DragEvidence> find_drag(const FittedDevice& fitted, const std::vector<std::string>& locked,
                                                    std::size_t record, double lowest, double highest);

/// What a record of a fit without drag shows, in words; nothing where it does not show (significant_friction, in deviations), or where the critical
/// stiffness beside it is within the interval.
[[nodiscard]] std::optional<std::string> doubt_of_drag(const std::optional<DragEvidence>& drag,
                                                       const Analysis& analysis, Motion motion);

}  // namespace zwidth::internal
