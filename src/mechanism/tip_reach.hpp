#pragma once

// Poses that bring the tip of a mechanism to a point.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "zwidth/mechanism.hpp"

namespace zwidth::internal {

// By these joints of model.joints(), of which the others follow: see MechanismModel::reach().
[[nodiscard]] MechanismModel::Reached reached_by(const MechanismModel& model, const std::vector<std::size_t>& joints,
                                                 const Eigen::Vector3d& point);

// Whether each joint, `positions` in their order, is within the range that the file gives it, but for rounding.
[[nodiscard]] bool is_within_ranges(const std::vector<MechanismJoint>& joints, const Eigen::VectorXd& positions);

}  // namespace zwidth::internal
