#pragma once

#include <Eigen/Core>

#include "zwidth/mechanism.hpp"

namespace zwidth::internal {

// Adds a motor behind a coordinate: one of its own where a cable is between, whose encoder is read where `is_read`.
void add_transmission(MechanismAtPose& mechanism, Eigen::Index joint, const Transmission& motor, bool is_read);

// In coordinates z that loops leave free, q' = Z z'.
[[nodiscard]] MechanismAtPose with_loops(const MechanismAtPose& mechanism, const Eigen::MatrixXd& free_motions);

}  // namespace zwidth::internal
