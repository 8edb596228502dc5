#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "identification/model/motion_model.hpp"

namespace zwidth::internal {

// Places where a search may begin: what stands for another in the first order is not reached from that.

/// x of the linear device with so much friction on a body, of the force, the less damping for it, and half its lateness as lag.
[[nodiscard]] Eigen::VectorXd with_friction_and_lag(Eigen::VectorXd x, const MotionModel& model,
                                                    const std::string& body, double share);

/// x with friction in the links that do not ring and half their damping. Nothing where there is no such link.
[[nodiscard]] std::optional<Eigen::VectorXd> with_link_frictions(Eigen::VectorXd x, const MotionModel& model);

/// z with forces of either sign as the linear device has them: short segments tell them badly, and over long ones a spring that
/// softens drives a body out of all bounds.
[[nodiscard]] Eigen::VectorXd without_forces(Eigen::VectorXd z, const MotionModel& model,
                                             const Eigen::VectorXd& linear);

/// x of a device whose numbers are known, with its friction and no other rival.
[[nodiscard]] Eigen::VectorXd of_known(const DeviceParameters& device, const DeviceFamily& family);

}  // namespace zwidth::internal
