#pragma once

// The limits at one pose of a mechanism.

#include <Eigen/Core>
#include <optional>

#include "zwidth/error.hpp"
#include "zwidth/mechanism.hpp"
#include "zwidth/model/device.hpp"
#include "zwidth/stability/absolute_stability.hpp"
#include "zwidth/stability/critical_stiffness.hpp"
#include "zwidth/workspace.hpp"

namespace zwidth::internal {

// What an error says, as data.
[[nodiscard]] Problem problem_of(const Error& error);

// The tip cannot move along this normal.
[[nodiscard]] Problem tip_stays_along(const Eigen::Vector3d& normal);

// The parameters of a device of a mechanism along another normal, which nobody holds.
[[nodiscard]] DeviceParameters alone_along(DeviceParameters parameters, const Eigen::Vector3d& normal);

// The limits along one normal, each by the route of a single device. Throws Error as device_along().
struct ExactLimits {
  CriticalStiffness nobody;
  std::optional<AbsoluteStabilityLimit> any_user;  // absent unless asked for and known
};
[[nodiscard]] ExactLimits exact_limits(const MechanismAtPose& at, const DeviceParameters& parameters,
                                       const Eigen::Vector3d& normal, bool with_any_user);

// Fills directions, refused, least, greatest and least_any_user of a pose, or its problem.
void add_limits(const MechanismAtPose& at, const DeviceParameters& parameters, const WorkspaceOptions& options,
                WorkspacePose& pose);

}  // namespace zwidth::internal
