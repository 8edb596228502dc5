#pragma once

#include <Eigen/Core>

#include "zwidth/mechanism.hpp"

namespace zwidth::internal {

// Relative: rows that depend on others to this are sums of them. At a singular pose of a loop they do to the root of rounding.
inline constexpr double dependent_below = 1e-6;

[[nodiscard]] Eigen::Index rank_of(const Eigen::MatrixXd& rows);

// Adds a motor behind a coordinate: one of its own where a cable is between, whose encoder is read where `is_read`.
void add_transmission(MechanismAtPose& mechanism, Eigen::Index joint, const Transmission& motor, bool is_read);

// In coordinates z that loops leave free, q' = Z z'.
[[nodiscard]] MechanismAtPose with_loops(const MechanismAtPose& mechanism, const Eigen::MatrixXd& free_motions);

// A cable whose length motors and those after it determine cannot keep it: it is a spring, and no cable of the result.
[[nodiscard]] MechanismAtPose without_springs(MechanismAtPose mechanism);

}  // namespace zwidth::internal
