#pragma once

#include <string>
#include <vector>

#include "results/json.hpp"
#include "zwidth/identification/inverse_dynamics.hpp"
#include "zwidth/model/device.hpp"

namespace zwidth::report {

/// A rigid device identified by inverse dynamics, the input of its reports.
struct IdentifiedRigidBody {
  std::string source;  ///< the recording's name
  RigidBodyFit fit;    ///< its remarks moved to the ones below
  Device device;
  std::vector<Remark> remarks;
};

/// The fitted body as a device that `analyze` takes, with the covariance of its parameters. Friction that came out
/// below 0 is taken as 0, and said. Throws Error (invalid_argument) where the fitted mass is not above 0.
[[nodiscard]] IdentifiedRigidBody identified_rigid_body(std::string source, RigidBodyFit fit, Motion motion,
                                                        double sampling_period);

/// The estimates in the order of the reports.
[[nodiscard]] std::vector<ParameterEstimate> estimates_of(const RigidBodyFit& fit);

/// The parameters with their intervals, how they were found, and every remark.
[[nodiscard]] std::string rigid_body_text(const IdentifiedRigidBody& identified);

/// Schema zwidth.inverse_dynamics/1: see docs/inverse_dynamics.md.
[[nodiscard]] results::Json rigid_body_json(const IdentifiedRigidBody& identified);

}  // namespace zwidth::report
